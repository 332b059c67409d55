#include "components/node/run.hpp"
#include "components/sim/sim_node.hpp"

int main(int argc, char** argv) { return node::run<sim::SimNode>(argc, argv); }
