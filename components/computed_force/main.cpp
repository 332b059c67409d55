#include "components/computed_force/computed_force.hpp"

int main(int argc, char** argv) { return node::run<control::ComputedForce>(argc, argv); }
