#include "components/node/type_schema.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <thread>

#include "interfaces/recording/cdr.hpp"
#include "interfaces/recording/ros2msg.hpp"
#include "tests/interfaces/recording/dds_capture.hpp"
#include "tests/interfaces/recording/example_messages.hpp"
#include "unusual_types.h"

using namespace recording;

namespace {

/// The type description after it was written to a schema and parsed again, as in a recording.
TypeDescription through_text(const dds_topic_descriptor_t& type) {
  const TypeDescription described = node::describe(type);
  return parse_ros2msg(described.name(), ros2msg_text(described));
}

/// A sample that Cyclone DDS serialized, decoded again. `decoded["a"]` is the field a as text.
class Decoded {
 public:
  Decoded(const dds_topic_descriptor_t& descriptor, const void* sample)
      : type_(through_text(descriptor)),
        members_(decode_cdr(type_, test::Capture().bytes_of(descriptor, sample))) {}
  std::string operator[](const std::string& field) const {
    const Value* value = members_.find(field);
    return value ? to_text(*value) : "no field " + field;
  }
  std::string json() const { return to_json(members_); }

 private:
  TypeDescription type_;
  Members members_;
};

template <class M>
Decoded example(std::uint64_t n = 3) {
  M m;
  test::fill(m, n);
  return {*erp::Topic<M>::type, static_cast<const typename M::Wire*>(&m)};
}

}  // namespace

TEST_CASE("the schema of sensor_frame has valid ROS 2 names and keeps names, units and bounds") {
  CHECK(
      ros2msg_text(node::describe(erp_SensorFrame_desc)) ==
      "string<=32 robot\nint64 stamp_ns  # [ns]\nuint64 sequence\n"
      "erp/ActuatorSample[<=64] actuators\nerp/JointSample[<=128] joints\n" +
          std::string(80, '=') +
          "\nMSG: erp/ActuatorSample\nstring<=32 name\nuint8 valid\nuint8 ecu_state\nuint8 "
          "ecu_fault\n"
          "uint8 mode\nfloat64 reference\nfloat64 voltage_v  # voltage_V [V]\n"
          "float64 current_a  # current_A [A]\nfloat64 shaft_rad  # [rad]\nfloat64 line_m  # [m]\n"
          "float64 tension_n  # tension_N [N]\nfloat64 potentiometer_rad  # [rad]\n" +
          std::string(80, '=') +
          "\nMSG: erp/JointSample\nstring<=32 name\nuint8 valid\n"
          "float64 angle_rad  # [rad]\n");
  CHECK(node::describe(erp_SensorFrame_desc).name() == "erp/msg/SensorFrame");
}

TEST_CASE("a message of every topic is decoded to the values that were written") {
  CHECK(
      example<erp::SensorFrame>().json() ==
      R"({"robot":"rig","stamp_ns":1700000000000000003,"sequence":3,"actuators":[)"
      R"({"name":"flexor","valid":31,"ecu_state":3,"ecu_fault":2,"mode":4,"reference":43.5,)"
      R"("voltage_V":1.25,"current_A":-0.3,"shaft_rad":0.3333333333333333,"line_m":-0.002,)"
      R"("tension_N":42.9,"potentiometer_rad":2.5},{"name":"a_name_of_thirty_two_characters_","valid":16,"ecu_state":3,)"
      R"("ecu_fault":2,"mode":0,"reference":43.5,"voltage_V":1.25,"current_A":-0.3,)"
      R"("shaft_rad":0.3333333333333333,"line_m":-0.002,"tension_N":5e-324,"potentiometer_rad":2.5}],)"
      R"("joints":[{"name":"elbow","valid":1,"angle_rad":0.7}]})");
  const auto command = example<erp::ActuatorCommand>();
  CHECK(command["controller"] == "reference");
  CHECK(command["answers"] == "43");
  CHECK(command["priority"] == "-3");
  CHECK(command["actuators"] == R"([{"name":"flexor","mode":4,"reference":3.1},)"
                                R"({"name":"extensor","mode":2,"reference":-1e-09}])");
  CHECK(example<erp::ActuatorTarget>()["actuators"] == command["actuators"]);
  CHECK(example<erp::EcuCommand>()["channels"] ==
        R"([{"ecu":1,"channel":2,"request":3,"setpoint":-400000}])");
  CHECK(example<erp::EcuFrame>()["channels"] ==
        R"([{"ecu":1,"channel":0,"fresh":true,"state":3,"fault":4,"request":5,"setpoint":-600000,)"
        R"("zero_known":true,"encoder_counts":700000,"duty_counts":-1023,"current_counts":-2048,)"
        R"("tension_counts":4095,)"
        R"("gain_sets_accepted":6,"gain_sets_refused":201},)"
        R"({"ecu":2,"channel":1,"fresh":false,"state":1,"fault":0,"request":2,"setpoint":9,)"
        R"("zero_known":false,"encoder_counts":8,"duty_counts":7,"current_counts":6,)"
        R"("tension_counts":5,)"
        R"("gain_sets_accepted":0,"gain_sets_refused":0}])");
  CHECK(example<erp::EcuFrame>()["analogs"] ==
        R"([{"ecu":1,"input":3,"fresh":true,"counts":-8191}])");
  const auto parameters = example<erp::EcuParameter>()["values"];
  CHECK(
      parameters.ends_with(R"({"ecu":1,"channel":0,"index":199,"commit":false,"value":24.875}])"));
  CHECK(example<erp::GainCommand>()["gains"] ==
        R"([{"name":"flexor","parameter":"length_gain_V_per_rad","value":12.5}])");
  CHECK(
      example<erp::JointState>()["joints"] ==
      R"([{"name":"shoulder","dof":3,"position":[0.5,1.5,2.5,3.5],"velocity_rad_per_s":[0,-1,-2],)"
      R"("variance_rad2":[0,1e-06,2e-06]},{"name":"elbow","dof":1,"position":[0.5,1.5,2.5,3.5],)"
      R"("velocity_rad_per_s":[0,-1,-2],"variance_rad2":[0,1e-06,2e-06]}])");
  CHECK(example<erp::BodyPose>()["bodies"] ==
        R"([{"name":"forearm","position_m":[0,0.25,0.5],"orientation_wxyz":[1,0,0,0]}])");
  CHECK(example<erp::ActuatorOwner>()["actuators"] ==
        R"([{"name":"flexor","owner":"force_control","priority":7,"safe_action":2,"limited":3,)"
        R"("refused":4000000000,"reason":"over 150 N, \"twice\""}])");
  const auto state = example<erp::ComponentState>();
  CHECK(state["pid"] == "4711");
  CHECK(state["steps"] == "1000000000000");
  CHECK(state["rate_Hz"] == "499.5");
  CHECK(state["age_bins"] == "[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23]");
  CHECK(state["note"] == "fine");
  CHECK(example<erp::LifecycleCommand>()["target"] == "4");
  CHECK(example<erp::Clock>()["real_time_factor"] == "7.5");
  CHECK(example<erp::Clock>()["finished"] == "true");
  CHECK(example<erp::Event>()["text"] == "no command for 22 ms");
}

TEST_CASE("stamp and sequence are decoded in every topic") {
  test::Capture capture;
  test::each_example(17, [&](const auto& m, const std::string& topic, const auto& descriptor) {
    using Wire = typename std::decay_t<decltype(m)>::Wire;
    const Bytes bytes = capture.bytes_of(descriptor, static_cast<const Wire*>(&m));
    const recording::Header header = header_of(through_text(descriptor), bytes);
    INFO(topic);
    CHECK(header.stamp_ns == m.stamp_ns);
    CHECK(header.sequence == 17u);
  });
}

// int8 is decoded as uint8, because XTypes 1.2 has only one type for bytes.
TEST_CASE("enums, bitmasks, typedefs, inheritance and nested arrays are decoded") {
  unusual_Everything m{};
  std::int32_t few[] = {5, -6};
  unusual_Inner inner{'x', -7, {1, 2, 3}};
  char words[2][6] = {"ab", "cdefg"};
  m.parent.head = 9, m.name = const_cast<char*>("key"), m.yes = true, m.i8 = -1, m.u8 = 200;
  m.i16 = -300, m.u16 = 60000, m.i32 = -70000, m.u32 = 4000000000, m.i64 = -5, m.u64 = 6;
  m.f32 = 0.25f, m.f64 = -0.5, m.paint = unusual_blue, m.little = unusual_yes,
  m.bits = unusual_hot | unusual_cold;
  m.at[2] = 8, m.rows[1][0] = 4, m.grid[1][2] = 12;
  m.few = {4, 2, few, false};
  m.many = {1, 1, &inner, false};
  m.two[0] = inner, m.two[1].tiny = 3;
  m.words._buffer = words, m.words._length = 2, m.words._maximum = 3;
  m.text = const_cast<char*>("free"), m.pair[1] = unusual_green;
  const Decoded decoded(unusual_Everything_desc, &m);
  CHECK(
      decoded.json() ==
      R"({"head":9,"name":"key","yes":true,"i8":255,"u8":200,"i16":-300,"u16":60000,"i32":-70000,)"
      R"("u32":4000000000,"i64":-5,"u64":6,"f32":0.25,"f64":-0.5,"paint":7,"little":1,"bits":2049,)"
      R"("at":[0,0,8],"rows":[0,0,0,4,0,0],"grid":[0,0,0,0,0,12],"few":[5,-6],)"
      R"("many":[{"letter":120,"tiny":249,"at":[1,2,3]}],)"
      R"("two":[{"letter":120,"tiny":249,"at":[1,2,3]},{"letter":0,"tiny":3,"at":[0,0,0]}],)"
      R"("words":["ab","cdefg"],"text":"free","pair":[0,1]})");
}

TEST_CASE("a type that a ROS 2 message cannot represent is rejected with type, member and reason") {
  CHECK_THROWS_WITH(node::describe(unusual_HasUnion_desc),
                    Catch::Contains("unusual::HasUnion.which is a union"));
  CHECK_THROWS_WITH(node::describe(unusual_HasOptional_desc),
                    Catch::Contains("unusual::HasOptional.maybe is optional"));
  CHECK_THROWS_WITH(node::describe(unusual_HasNested_desc),
                    Catch::Contains("unusual::HasNested.deep nests sequences"));
  CHECK_THROWS_WITH(node::describe(unusual_Growing_desc),
                    Catch::Contains("unusual::Growing is not @final"));
  dds_topic_descriptor_t bare = unusual_Left_desc;
  bare.type_mapping = {nullptr, 0};
  CHECK_THROWS_WITH(node::describe(bare), Catch::Contains("no type information"));
}

TEST_CASE("a type discovered on the bus has the same description as the compiled type") {
  test::Capture remote(78), local(79);  // two domains that discover each other like two processes
  const dds_entity_t topic =
      dds_create_topic(remote.participant(), &unusual_Everything_desc, "unusual", nullptr, nullptr);
  dds_create_writer(remote.participant(), topic, nullptr, nullptr);
  const dds_entity_t publications =
      dds_create_reader(local.participant(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  std::string text;
  while (text.empty()) {
    void* sample = nullptr;
    dds_sample_info_t info;
    if (dds_take(publications, &sample, &info, 1, 1) != 1) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      continue;
    }
    auto* endpoint = static_cast<dds_builtintopic_endpoint_t*>(sample);
    const dds_typeinfo_t* type_info = nullptr;
    dds_topic_descriptor_t* discovered_type = nullptr;
    if (info.valid_data && std::string(endpoint->topic_name) == "unusual" &&
        dds_builtintopic_get_endpoint_type_info(endpoint, &type_info) == DDS_RETCODE_OK &&
        type_info &&
        dds_create_topic_descriptor(DDS_FIND_SCOPE_GLOBAL, local.participant(), type_info,
                                    DDS_SECS(5), &discovered_type) == DDS_RETCODE_OK) {
      text = ros2msg_text(node::describe(*discovered_type));
      dds_delete_topic_descriptor(discovered_type);
    }
    dds_return_loan(publications, &sample, 1);
  }
  CHECK(text == ros2msg_text(node::describe(unusual_Everything_desc)));
}
