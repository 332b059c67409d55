#include <variant>

#include "interfaces/robot/assemble.hpp"

namespace erp {
namespace {

// p → M p, M = diag(1, −1, 1). Zero keeps its sign: files do not contain "-0".
double negated(double x) { return x == 0.0 ? 0.0 : -x; }
Vec3 reflected(const Vec3& p) { return {p[0], negated(p[1]), p[2]}; }
// a → −M a
Vec3 reflected_axis(const Vec3& a) { return {negated(a[0]), a[1], negated(a[2])}; }

void reflect(Sphere& sphere) { sphere.at_m = reflected(sphere.at_m); }
void reflect(Box& box) { box.at_m = reflected(box.at_m); }
void reflect(Weight& weight) { weight.at_m = reflected(weight.at_m); }
void reflect(Capsule& capsule) {
  capsule.from_m = reflected(capsule.from_m), capsule.to_m = reflected(capsule.to_m);
}

void reflect(Skeleton& skeleton) {
  if (auto& gravity = skeleton.gravity_m_per_s2) gravity = reflected(*gravity);
  for (Body& body : skeleton.bodies) {
    body.com_m = reflected(body.com_m);
    auto& products = body.products_kg_m2;
    products = {negated(products[0]), products[1], negated(products[2])};
    for (Part& part : body.parts) std::visit([](auto& p) { reflect(p); }, part);
  }
  for (Joint& joint : skeleton.joints) {
    joint.at_m = reflected(joint.at_m);
    joint.axis = reflected_axis(joint.axis);
  }
}

void reflect(Attach& attach) { attach.at_m = reflected(attach.at_m); }
void reflect(Pulley& pulley) {
  pulley.center_m = reflected(pulley.center_m);
  pulley.side = reflected(pulley.side);
  if (auto& axis = pulley.axis) axis = reflected_axis(*axis);
}

/// The mirror image of a rotation vector is (−x, y, −z): readings about x and z change sign.
void reflect(JointSensor& sensor) {
  if (!sensor.about || *sensor.about == AxisName::y) return;
  std::swap(sensor.min_rad, sensor.max_rad);
  for (auto* end : {&sensor.min_rad, &sensor.max_rad})
    if (*end) **end = negated(**end);
}

/// Replaces the prefix `from` of a name by `to`.
struct PrefixReplacement {
  const Mirror& mirror;
  void operator()(std::string& name) const {
    if (name.starts_with(mirror.from)) name.replace(0, mirror.from.size(), mirror.to);
  }
  template <class... Names>
  void each(Names&... names) const {
    ((*this)(names), ...);
  }
};

void rename(Skeleton& skeleton, const PrefixReplacement& replace_prefix) {
  for (Body& body : skeleton.bodies) replace_prefix(body.name);
  for (Joint& joint : skeleton.joints) replace_prefix.each(joint.name, joint.parent, joint.child);
  for (Contact& contact : skeleton.contacts) replace_prefix.each(contact.body, contact.on);
}

}  // namespace

Robot mirrored(Robot part, const Mirror& mirror) {
  const PrefixReplacement replace_prefix{mirror};
  for (Skeleton& skeleton : part.skeletons) reflect(skeleton), rename(skeleton, replace_prefix);
  for (MotorType& type : part.motor_types) replace_prefix(type.name);
  for (SensorType& type : part.sensor_types) replace_prefix(type.name);
  for (Actuator& actuator : part.actuators) {
    replace_prefix.each(actuator.name, actuator.limb, actuator.motor, actuator.sensors);
    for (auto& point : actuator.tendon.path)
      std::visit([&](auto& p) { reflect(p), replace_prefix(p.body); }, point);
  }
  for (Drive& drive : part.drives) replace_prefix.each(drive.name, drive.motor);
  for (Pretension& pretension : part.pretensions) replace_prefix(pretension.actuator);
  for (Effect& effect : part.effects) replace_prefix(effect.on);
  for (Tolerance& tolerance : part.tolerances) replace_prefix(tolerance.on);
  for (JointSensor& sensor : part.joint_sensors) replace_prefix(sensor.joint), reflect(sensor);
  for (Potentiometer& sensor : part.potentiometers) replace_prefix(sensor.actuator);
  for (BusPlan& bus : part.can_buses) replace_prefix(bus.name);
  for (Imu& imu : part.imus)
    imu.at_m = reflected(imu.at_m), replace_prefix.each(imu.name, imu.body);
  return part;
}

}  // namespace erp
