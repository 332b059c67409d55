#include "components/gateway/gateway_node.hpp"
#include "components/node/run.hpp"

int main(int argc, char** argv) { return node::run<can::GatewayNode>(argc, argv); }
