#include "components/node/run.hpp"
#include "components/reference/joint_player.hpp"

int main(int argc, char** argv) { return node::run<reference::JointPlayer>(argc, argv); }
