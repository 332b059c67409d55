#include "components/node/run.hpp"
#include "components/replay/replay_node.hpp"

int main(int argc, char** argv) { return node::run<replay::ReplayNode>(argc, argv); }
