#include "components/sensorimotor/sensorimotor.hpp"

int main(int argc, char** argv) { return node::run<control::Sensorimotor>(argc, argv); }
