#include <catch2/catch.hpp>

#include "interfaces/robot/mass.hpp"
#include "sim/formats/formats.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"
#include "tests/sim/formats/file.hpp"
#include "tests/sim/rigs.hpp"

namespace {

struct Format {
  const char* name;
  std::string (*write)(const erp::Robot&);
  erp::Robot (*read)(const std::string&);
};

bool nearly_equal(const xml::Vec3& a, const xml::Vec3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < 1e-12;
}

template <class Items>
const auto& item_named(const Items& items, const std::string& name) {
  for (const auto& item : items)
    if (item.name == name) return item;
  throw std::out_of_range(name);
}

void check_equal(const erp::Robot& expected, const erp::Robot& actual) {
  const auto bodies = actual.bodies();
  const auto joints = actual.joints();
  CHECK(bodies.size() == expected.bodies().size());
  for (const erp::Body& body : expected.bodies()) {
    CAPTURE(body.name);
    const erp::Mass a = mass_of(body), b = mass_of(item_named(bodies, body.name));
    CHECK(a.mass_kg == b.mass_kg);
    CHECK((a.mass_kg == 0 || nearly_equal(a.com_m, b.com_m)));
    for (std::size_t k = 0; k < 6 && a.mass_kg > 0; ++k)
      CHECK(a.inertia_kg_m2[k] == Approx(b.inertia_kg_m2[k]).margin(1e-12));
  }
  CHECK(joints.size() == expected.joints().size());
  for (const erp::Joint& joint : expected.joints()) {
    CAPTURE(joint.name);
    const erp::Joint& other = item_named(joints, joint.name);
    CHECK(other.type == joint.type);
    CHECK(other.parent == joint.parent);
    CHECK(other.child == joint.child);
    CHECK(nearly_equal(other.at_m, joint.at_m));
    if (joint.type != erp::JointType::revolute) continue;
    CHECK(other.min_rad == joint.min_rad);
    CHECK(other.max_rad == joint.max_rad);
    CHECK(other.viscous_Nm_s_per_rad == joint.viscous_Nm_s_per_rad);
    CHECK(other.coulomb_Nm == joint.coulomb_Nm);
  }
}

}  // namespace

TEST_CASE("export and import of a skeleton returns the same skeleton") {
  const Format format = GENERATE(Format{"urdf", formats::to_urdf, formats::from_urdf},
                                 Format{"sdf", formats::to_sdf, formats::from_sdf});
  for (const char* robot : {"hinge_rig", "arm", "seven_dof", "ecce4"}) {
    CAPTURE(format.name, robot);
    const erp::Robot expected = erp::read_robot(rigs::config(std::string(robot) + "/robot.xml"));
    const File file(format.write(expected));
    check_equal(expected, format.read(file.path));
  }
}

TEST_CASE("rotated frames of URDF are converted to parallel frames") {
  const File file(R"(<robot name="r"><link name="base"/>
    <link name="rod"><inertial><origin xyz="0.1 0 0" rpy="0 0 1.5707963267948966"/>
      <mass value="2"/><inertia ixx="1" iyy="2" izz="2.5" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="j" type="continuous"><parent link="base"/><child link="rod"/>
      <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="1 0 0"/></joint></robot>)");
  const erp::Robot robot = formats::from_urdf(file.path);
  const erp::Body rod = robot.bodies().at(1);
  CHECK(nearly_equal(rod.com_m, {0, 0.1, 0}));
  CHECK(nearly_equal(rod.inertia_kg_m2, {1, 2, 2.5}));  // rotated twice by a quarter turn
  CHECK(nearly_equal(robot.joints().at(0).axis, {0, 1, 0}));
  CHECK(nearly_equal(robot.joints().at(0).at_m, {0, 0, 1}));
}

TEST_CASE("an error in a URDF file is reported with its position") {
  const auto check_error = [](const char* text, const char* message) {
    const File file(text);
    CHECK_THROWS_WITH(formats::from_urdf(file.path), Catch::Contains(message));
  };
  check_error("<model/>", ":1:1: <model>: is not a URDF file");
  check_error("<robot><link name='a'/></robot>", "has no name");
  check_error(
      "<robot name='r'><link name='a'/><link name='b'/>\n<joint name='j' type='prismatic'>"
      "<parent link='a'/><child link='b'/></joint></robot>",
      ":2:1: <joint>: type=\"prismatic\" is not supported; use revolute");
  check_error(
      "<robot name='r'><link name='a'><inertial>\n<mass value='heavy'/><inertia ixx='1' iyy='1' "
      "izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>",
      ":2:1: <mass>: value=\"heavy\"");
  check_error(
      "<robot name='r'><link name='a'/><joint name='j' type='fixed'><parent link='a'/>"
      "<child link='c'/></joint></robot>",
      "at least one of them is not a link");
  check_error(
      "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'>"
      "<parent link='a'/><child link='b'/></joint><joint name='k' type='fixed'>"
      "<parent link='b'/><child link='a'/></joint></robot>",
      "loop");
}
