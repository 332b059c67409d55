#include "components/eye/eye.hpp"

int main(int argc, char** argv) { return node::run<eye::Eye>(argc, argv); }
