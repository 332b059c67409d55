#include "interfaces/robot/assemble.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "interfaces/xml/errors.hpp"

namespace fs = std::filesystem;

namespace {

/// A temporary folder; the destructor removes it.
class Files {
 public:
  Files() : folder_(fs::temp_directory_path() / ("erp_assemble_" + std::to_string(getpid()))) {
    fs::create_directories(folder_ / "parts");
  }
  ~Files() { fs::remove_all(folder_); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_;
};

const char* const types_xml = R"(<robot name="types">
  <motor_type name="m" resistance_ohm="1" inductance_H="1" back_emf_V_s_per_rad="1"
              torque_Nm_per_A="1" gear_ratio="1" gear_efficiency="1" rotor_inertia_kg_m2="1"
              supply_V="12" current_limit_A="1"/>
  <sensor_type name="s" encoder_counts_per_rev="1" current_bits="12" current_range_A="1"
               tension_bits="12" tension_range_N="200"/>
</robot>)";

const char* const arm_xml = R"(<robot name="arm_part">
  <include file="types.xml"/>
  <skeleton>
    <body name="left_arm" mass_kg="1" com_m="0.1 0.02 -0.3" inertia_kg_m2="1 1 1"/>
    <joint name="left_shoulder" type="revolute" parent="torso" child="left_arm"
           at_m="0 0.2 0.4" axis="1 2 3" min_rad="-0.5" max_rad="1.5"/>
  </skeleton>
  <actuator name="left_deltoid" motor="m" sensors="s" ecu="2" channel="1" safe_action="hold"
            max_tension_N="100">
    <spindle radius_m="0.005"/>
    <tendon stiffness_N_per_m="1000">
      <attach body="torso" at_m="0 0.1 0.5"/>
      <pulley body="left_arm" center_m="0.01 0.02 0.03" radius_m="0.01" side="0 1 0"/>
      <attach body="left_arm" at_m="0 -0.03 -0.2"/>
    </tendon>
  </actuator>
  <joint_sensor joint="left_shoulder" ecu="2" input="1" bits_per_rev="14"/>
</robot>)";

const char* const two_arms_xml = R"(<robot name="both">
  <include file="parts/arm.xml"/>
  <mirror file="parts/arm.xml" from="left_" to="right_" ecu_offset="14"/>
  <skeleton gravity_m_per_s2="0 0 -9.81"><body name="torso"/></skeleton>
</robot>)";

erp::Robot two_arms(const Files& files) {
  files.put("parts/types.xml", types_xml);
  files.put("parts/arm.xml", arm_xml);
  files.put("both.xml", two_arms_xml);
  return erp::read_robot(files.path("both.xml"));
}

template <class Items>
const auto& find_by_name(const Items& items, const std::string& name) {
  for (const auto& item : items)
    if (item.name == name) return item;
  throw std::out_of_range(name);
}

using Matrix = std::array<erp::Vec3, 3>;

/// Rodrigues' formula: R = E cos q + [n]× sin q + n nᵀ (1 − cos q), E the unit matrix.
Matrix rotation(erp::Vec3 n, double q) {
  const double length = std::hypot(n[0], n[1], n[2]);
  for (double& x : n) x /= length;
  const double c = std::cos(q), s = std::sin(q);
  const Matrix cross{{{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}}};
  Matrix r{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      r[i][j] = (i == j ? c : 0) + cross[i][j] * s + n[i] * n[j] * (1 - c);
  return r;
}

/// Position of a point `p` of the child in the frame of the parent, at the joint angle q in rad.
erp::Vec3 in_parent(const erp::Joint& joint, double q, const erp::Vec3& p) {
  const Matrix r = rotation(joint.axis, q);
  erp::Vec3 out = joint.at_m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i] += r[i][j] * p[j];
  return out;
}

}  // namespace

TEST_CASE("nested includes are read, with paths relative to the including file") {
  const Files files;
  const erp::Robot robot = two_arms(files);
  CHECK(robot.name == "both");
  CHECK(robot.includes.empty());
  CHECK(robot.mirrors.empty());
  CHECK(robot.bodies().size() == 3);
  CHECK(robot.actuators.size() == 2);
  CHECK(robot.motor_types.size() == 1);
  CHECK(find_by_name(robot.actuators, "left_deltoid").place.file == files.path("parts/arm.xml"));
}

TEST_CASE("a mirrored part has its names, references and ecus replaced") {
  const Files files;
  const erp::Robot robot = two_arms(files);
  const auto& deltoid = find_by_name(robot.actuators, "right_deltoid");
  CHECK(deltoid.ecu == 16);
  CHECK(deltoid.channel == 1);
  CHECK(deltoid.motor == "m");
  CHECK(std::get<erp::Attach>(deltoid.tendon.path[0]).body == "torso");
  CHECK(std::get<erp::Pulley>(deltoid.tendon.path[1]).body == "right_arm");
  CHECK(robot.joint_sensors[1].joint == "right_shoulder");
  CHECK(robot.joint_sensors[1].ecu == 16);
  const auto joints = robot.joints();
  const auto& shoulder = find_by_name(joints, "right_shoulder");
  CHECK(shoulder.parent == "torso");
  CHECK(shoulder.child == "right_arm");
  CHECK(shoulder.min_rad == -0.5);
}

TEST_CASE("points of a mirrored part have the opposite sign of y") {
  const Files files;
  const erp::Robot robot = two_arms(files);
  const auto bodies = robot.bodies();
  CHECK(find_by_name(bodies, "right_arm").com_m == erp::Vec3{0.1, -0.02, -0.3});
  const auto& path = find_by_name(robot.actuators, "right_deltoid").tendon.path;
  CHECK(std::get<erp::Attach>(path[0]).at_m == erp::Vec3{0, -0.1, 0.5});
  CHECK(std::get<erp::Pulley>(path[1]).center_m == erp::Vec3{0.01, -0.02, 0.03});
  CHECK(std::get<erp::Pulley>(path[1]).side == erp::Vec3{0, -1, 0});
  CHECK(std::get<erp::Attach>(path[2]).at_m == erp::Vec3{0, 0.03, -0.2});
}

TEST_CASE("at the same joint angle a mirrored body is the mirror image") {
  const Files files;
  const erp::Robot robot = two_arms(files);
  const auto joints = robot.joints();
  const erp::Vec3 p{0.3, -0.7, 0.2}, mirror_p{0.3, 0.7, 0.2};
  for (double q : {-0.4, 0.0, 0.9, 1.5}) {
    const auto left = in_parent(find_by_name(joints, "left_shoulder"), q, p);
    const auto right = in_parent(find_by_name(joints, "right_shoulder"), q, mirror_p);
    CHECK(right[0] == Approx(left[0]).margin(1e-15));
    CHECK(right[1] == Approx(-left[1]).margin(1e-15));
    CHECK(right[2] == Approx(left[2]).margin(1e-15));
  }
}

TEST_CASE("mirroring twice gives the same robot, bit-equal") {
  const Files files;
  two_arms(files);
  const erp::Robot part = erp::assemble_robot(files.path("parts/arm.xml"));
  const erp::Robot mirrored_part = erp::mirrored(part, {{}, "", "left_", "right_", 14});
  const erp::Robot mirrored_twice = erp::mirrored(mirrored_part, {{}, "", "right_", "left_", -14});
  CHECK(erp::write_robot(mirrored_part) != erp::write_robot(part));
  CHECK(erp::write_robot(mirrored_twice) == erp::write_robot(part));
}

TEST_CASE("an assembled robot written to one file is read back equal") {
  const Files files;
  const erp::Robot robot = two_arms(files);
  files.put("flat.xml", erp::write_robot(robot));
  CHECK(erp::write_robot(erp::read_robot(files.path("flat.xml"))) == erp::write_robot(robot));
}

TEST_CASE("a circular include is rejected with its place") {
  const Files files;
  files.put("a.xml", "<robot name='a'><include file='b.xml'/></robot>");
  files.put("b.xml", "<robot name='b'>\n<mirror file='a.xml' from='l' to='r'/></robot>");
  try {
    erp::read_robot(files.path("a.xml"));
    FAIL("was accepted");
  } catch (const xml::Errors& errors) {
    CHECK_THAT(errors.what(),
               Catch::Contains("b.xml:2:1: <mirror>: file=\"a.xml\" includes itself"));
  }
}

TEST_CASE("includes that double at each level are rejected") {
  const Files files;
  constexpr int levels = 40;  // 2^40 files
  for (int k = 0; k < levels; ++k) {
    const std::string next = "<include file='" + std::to_string(k + 1) + ".xml'/>";
    files.put(std::to_string(k) + ".xml", "<robot name='a'>" + next + next + "</robot>");
  }
  files.put(std::to_string(levels) + ".xml", "<robot name='a'/>");
  try {
    erp::read_robot(files.path("0.xml"));
    FAIL("was accepted");
  } catch (const xml::Errors& errors) {
    CHECK(errors.all().size() == 1);
    CHECK_THAT(errors.what(), Catch::Contains("is one file too many: the robot already has 500"));
  }
}

TEST_CASE("the errors of all included files are reported at once") {
  const Files files;
  files.put("a.xml", "<robot name='a' x=''><include file='b.xml'/><include file='c.xml'/></robot>");
  files.put("b.xml", "<robot nam='b'/>");
  files.put("c.xml", "<robot");
  try {
    erp::read_robot(files.path("a.xml"));
    FAIL("was accepted");
  } catch (const xml::Errors& errors) {
    CHECK(errors.all().size() == 3);
  }
}
