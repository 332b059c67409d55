#include "components/synergy/synergy.hpp"

int main(int argc, char** argv) { return node::run<control::Synergy>(argc, argv); }
