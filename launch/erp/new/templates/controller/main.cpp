#include "@name@.hpp"
#include "components/node/run.hpp"

int main(int argc, char** argv) { return node::run<@Class@>(argc, argv); }
