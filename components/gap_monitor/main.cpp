#include "components/gap_monitor/gap_monitor.hpp"
#include "components/node/run.hpp"

int main(int argc, char** argv) { return node::run<GapMonitor>(argc, argv); }
