#include "components/experience/experience.hpp"

int main(int argc, char** argv) { return node::run<control::Experience>(argc, argv); }
