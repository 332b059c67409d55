#include "components/length_control/length_control.hpp"

int main(int argc, char** argv) { return node::run<LengthControl>(argc, argv); }
