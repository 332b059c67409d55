#include "components/node/run.hpp"
#include "components/gateway/gateway_node.hpp"

int main(int argc, char** argv) { return node::run<can::GatewayNode>(argc, argv); }
