#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/cdr.hpp"
#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/ros2msg.hpp"

namespace tests {

/// All messages of one topic of a recording, decoded, in the order of their time stamps.
class Recorded {
 public:
  Recorded(const std::string& file, const std::string& topic) {
    const recording::McapReader reader(file);
    reader.for_each([&](const recording::Message& message) {
      if (message.channel.topic != topic) return;
      if (type_.structures.empty()) {
        const auto& schema = reader.schemas().at(message.channel.schema_id);
        type_ = recording::parse_ros2msg(schema.name, schema.data);
      }
      messages_.push_back(recording::decode_cdr(type_, message.data));
    });
  }
  Recorded(const Recorded&) = delete;
  Recorded& operator=(const Recorded&) = delete;
  const std::vector<recording::Members>& messages() const { return messages_; }

 private:
  recording::TypeDescription type_;
  std::vector<recording::Members> messages_;
};

inline double number(const recording::Members& m, const char* name) {
  return m.find(name)->number().value();
}
inline std::string text(const recording::Members& m, const char* name) {
  return *m.find(name)->text();
}
inline const recording::Values& elements(const recording::Members& m, const char* name) {
  return *m.find(name)->elements();
}

}  // namespace tests
