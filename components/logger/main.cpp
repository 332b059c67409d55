#include "components/logger/logger_node.hpp"
#include "components/node/run.hpp"

int main(int argc, char** argv) { return node::run<logger::LoggerNode>(argc, argv); }
