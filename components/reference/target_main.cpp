#include "components/node/run.hpp"
#include "components/reference/reference.hpp"

int main(int argc, char** argv) {
  return node::run<reference::Reference<erp::ActuatorTarget>>(argc, argv);
}
