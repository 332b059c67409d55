#include "components/node/run.hpp"
#include "components/plant/plant_node.hpp"

int main(int argc, char** argv) { return node::run<plant::PlantNode>(argc, argv); }
