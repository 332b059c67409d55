#include "components/node/run.hpp"
#include "hal/can/gateway_node.hpp"

int main(int argc, char** argv) { return node::run<can::GatewayNode>(argc, argv); }
