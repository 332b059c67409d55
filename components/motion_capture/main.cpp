#include "components/motion_capture/motion_capture.hpp"

int main(int argc, char** argv) { return node::run<capture::MotionCapture>(argc, argv); }
