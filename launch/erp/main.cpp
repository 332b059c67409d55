#include "launch/erp/cli.hpp"

int main(int argc, char** argv) { return launch::run_command_line(argc, argv); }
