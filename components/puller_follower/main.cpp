#include "components/puller_follower/puller_follower.hpp"

int main(int argc, char** argv) { return node::run<control::PullerFollower>(argc, argv); }
