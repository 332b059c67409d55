#include "components/force_control/force_control.hpp"

int main(int argc, char** argv) { return node::run<ForceControl>(argc, argv); }
