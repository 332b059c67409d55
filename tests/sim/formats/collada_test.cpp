#include <1.5/dom/domCOLLADA.h>
#include <dae.h>
#include <dae/daeErrorHandler.h>

#include <catch2/catch.hpp>

#include "interfaces/robot/check.hpp"
#include "interfaces/robot/mass.hpp"
#include "interfaces/xml/errors.hpp"
#include "sim/formats/formats.hpp"
#include "tests/sim/formats/file.hpp"
#include "tests/sim/rigs.hpp"

namespace {

const std::vector<std::string> robots{"hinge_rig", "twin_joint", "seven_dof", "pendulum", "arm",
                                      "ecce1",     "ecce2",      "ecce3",     "ecce4"};

erp::Robot read(const std::string& name) {
  return erp::read_robot(rigs::config(name + "/robot.xml"));
}

erp::Robot through_file(const std::string& collada) {
  return formats::from_collada(File(collada, ".dae").path);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

std::string without_extra(const std::string& text) {
  const auto from = text.find("<extra"), to = text.find("</extra>");
  REQUIRE(to != std::string::npos);
  return text.substr(0, from) + text.substr(to + 8);
}

/// The third-party reader collada-dom; collects its errors and warnings in `messages`.
class Dom : daeErrorHandler {
 public:
  explicit Dom(const std::string& file) {
    daeErrorHandler::setErrorHandler(this);
    root_ = static_cast<ColladaDOM150::domCOLLADA*>(dae_.open(file));
    daeErrorHandler::setErrorHandler(nullptr);
  }
  ColladaDOM150::domCOLLADA* root() { return root_; }
  bool write(const std::string& from, const std::string& to) { return dae_.writeTo(from, to); }
  template <class Element>
  std::vector<Element*> all() {
    return dae_.getDatabase()->typeLookup<Element>();
  }
  std::string messages;

 private:
  void handleError(daeString message) override { messages += message; }
  void handleWarning(daeString message) override { messages += message; }
  DAE dae_{nullptr, nullptr, "1.5.0"};
  ColladaDOM150::domCOLLADA* root_ = nullptr;
};

/// A rod on a hinge as another program might write it: in centimetres, with y upwards.
const std::string foreign =
    R"(<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
  <asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
  <library_joints><joint id="j"><revolute sid="a"><axis>0 0 1</axis>
    <limits><min>-90</min><max>45</max></limits></revolute></joint></library_joints>
  <library_kinematics_models><kinematics_model id="k"><technique_common>
    <instance_joint url="#j" sid="swing"/>
    <link sid="stand"><attachment_full joint="k/swing"><translate>0 100 0</translate>
      <rotate>0 1 0 90</rotate><link sid="rod"/></attachment_full></link>
  </technique_common></kinematics_model></library_kinematics_models>
  <library_physics_models><physics_model id="p">
    <rigid_body sid="rod"><technique_common><mass>2</mass>
      <mass_frame><translate>10 0 0</translate></mass_frame>
      <inertia>100 200 300</inertia></technique_common></rigid_body>
  </physics_model></library_physics_models></COLLADA>)";

}  // namespace

TEST_CASE("export to and import from COLLADA returns the same robot bit for bit") {
  for (const auto& name : robots) {
    CAPTURE(name);
    const erp::Robot robot = read(name);
    CHECK(erp::write_robot(through_file(formats::to_collada(robot))) == erp::write_robot(robot));
  }
}

TEST_CASE(
    "collada-dom reads exported files without messages and finds the same joints and masses") {
  for (const auto& name : robots) {
    CAPTURE(name);
    const erp::Robot robot = read(name);
    const File file(formats::to_collada(robot), ".dae");
    Dom dom(file.path);
    REQUIRE(dom.root());
    CHECK(dom.messages == "");
    const auto joints = dom.all<ColladaDOM150::domJoint>();
    const auto expected_joints = robot.joints();
    REQUIRE(joints.size() == expected_joints.size());
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const erp::Joint& expected = expected_joints[k];
      CHECK(joints[k]->getName() == expected.name);
      if (expected.type != erp::JointType::revolute) continue;
      const auto& hinge = *joints[k]->getRevolute_array()[0];
      CHECK(hinge.getLimits()->getMax()->getValue() * M_PI / 180 == Approx(expected.max_rad));
      for (std::size_t i = 0; i < 3; ++i) CHECK(hinge.getAxis()->getValue()[i] == expected.axis[i]);
    }
    double mass_kg = 0, expected_kg = 0;
    for (auto* body : dom.all<ColladaDOM150::domRigid_body>())
      if (const auto mass = body->getTechnique_common()->getMass()) mass_kg += mass->getValue();
    for (const erp::Body& body : robot.bodies()) expected_kg += mass_of(body).mass_kg;
    CHECK(mass_kg == Approx(expected_kg).epsilon(1e-12));
  }
}

TEST_CASE("a file that collada-dom has read and rewritten gives the same robot") {
  const erp::Robot robot = read("arm");
  const File file(formats::to_collada(robot), ".dae"), rewritten("", "_again.dae");
  Dom dom(file.path);
  REQUIRE(dom.write(file.path, rewritten.path));
  CHECK(erp::write_robot(formats::from_collada(rewritten.path)) == erp::write_robot(robot));
}

TEST_CASE("a value that another program changed in the standard elements takes precedence") {
  const erp::Robot rig = read("hinge_rig");
  const std::string text = formats::to_collada(rig);
  const erp::Robot heavier = through_file(replaced(text, "<mass>0.8</mass>", "<mass>0.9</mass>"));
  CHECK(mass_of(heavier.bodies()[1]).mass_kg == 0.9);
  CHECK(heavier.actuators.size() == 2);
  const erp::Robot moved = through_file(
      replaced(text, "<attachment_full joint=\"kinematics/elbow\">\n            <translate>0 0 0",
               "<attachment_full joint=\"kinematics/elbow\">\n            <translate>0 0 0.1"));
  CHECK(moved.joints()[0].at_m == xml::Vec3{0, 0, 0.1});
  CHECK(moved.joints()[0].max_rad == rig.joints()[0].max_rad);
  CHECK_THROWS_WITH(through_file(replaced(text, "<link sid=\"forearm\" name=\"forearm\"",
                                          "<link sid=\"arm\" name=\"arm\"")),
                    Catch::Contains("body \"arm\" is not in the extra"));
}

TEST_CASE("the mass of the base is unchanged, and a changed gravity is imported") {
  erp::Robot robot = read("hinge_rig");
  erp::Body& base = robot.skeletons[0].bodies[0];
  base.density_kg_per_m3 = 1000;
  base.parts = {erp::Box{{}, {0, 0, 0}, {0.1, 0.1, 0.1}}, erp::Weight{{}, {0, 0, 0}, 2, ""}};
  const std::string text = formats::to_collada(robot);
  CHECK(erp::write_robot(through_file(text)) == erp::write_robot(robot));
  const erp::Robot moon = through_file(replaced(text, "<gravity>0 0 -9.81", "<gravity>0 0 -1.62"));
  CHECK(moon.gravity_m_per_s2() == xml::Vec3{0, 0, -1.62});
}

TEST_CASE("without the extra element, the skeleton is imported") {
  for (const auto& name : robots) {
    CAPTURE(name);
    const erp::Robot robot = read(name);
    const erp::Robot bare = through_file(without_extra(formats::to_collada(robot)));
    CHECK(bare.actuators.empty());
    REQUIRE(bare.joints().size() == robot.joints().size());
    double expected_kg = 0, actual_kg = 0;
    for (const erp::Body& body : robot.bodies()) expected_kg += mass_of(body).mass_kg;
    for (const erp::Body& body : bare.bodies()) actual_kg += mass_of(body).mass_kg;
    CHECK(actual_kg == Approx(expected_kg).epsilon(1e-12));
    CHECK(erp::check_robot(bare).empty());
  }
}

TEST_CASE("unit, upward axis and rotated frames of another program's file are converted") {
  const erp::Robot robot = through_file(foreign);
  const erp::Joint joint = robot.joints()[0];
  CHECK(joint.at_m[2] == Approx(1.0));  // y upwards becomes z
  CHECK(joint.axis[0] == Approx(1.0));  // z of a frame rotated about y
  CHECK(joint.min_rad == Approx(-M_PI / 2));
  const erp::Mass rod = mass_of(robot.bodies()[1]);
  CHECK(rod.mass_kg == 2);
  CHECK(rod.com_m[1] == Approx(0.1));
  CHECK(rod.inertia_kg_m2[0] == Approx(0.03));
  CHECK(rod.inertia_kg_m2[1] == Approx(0.01));
  CHECK(rod.inertia_kg_m2[2] == Approx(0.02));
}

TEST_CASE("an invalid file is rejected with place and remedy") {
  const auto error_of = [](const std::string& text) -> std::string {
    try {
      through_file(text);
    } catch (const xml::Errors& errors) {
      return errors.what();
    }
    return "";
  };
  using Catch::Contains;
  CHECK_THAT(error_of("<robot/>"),
             Contains("1:1") && Contains("the root element must be <COLLADA>"));
  CHECK_THAT(error_of(replaced(foreign, "1.5.0", "1.4.1")), Contains("export COLLADA 1.5"));
  CHECK_THAT(error_of(replaced(foreign, "#j\"", "#k\"")),
             Contains(":6:5") && Contains("names no joint"));
  CHECK_THAT(error_of(replaced(foreign, "k/swing", "k/sway")),
             Contains("<instance_joint sid=\"sway\">"));
  CHECK_THAT(error_of(replaced(foreign, "0 100 0", "0 100")), Contains("contains 2 numbers"));
  CHECK_THAT(error_of(replaced(foreign, "0 100 0", "0 1OO 0")), Contains(":7:"));
  CHECK_THAT(error_of(replaced(foreign, "<axis>0 0 1</axis>", "")), Contains("has no <axis>"));
  CHECK_THAT(error_of(replaced(foreign, "revolute sid", "prismatic sid")), Contains("prismatic"));
  CHECK_THAT(error_of(replaced(foreign, "</joint>", "")), Contains(":4:") && Contains("joint"));
}
