#include <cstdio>
#include <exception>
#include <fstream>

#include "components/node/type_schema.hpp"
#include "interfaces/recording/cdr.hpp"
#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/recorder.hpp"
#include "interfaces/recording/ros2msg.hpp"
#include "tests/interfaces/recording/dds_capture.hpp"
#include "tests/interfaces/recording/example_messages.hpp"

// fixture write FILE.mcap FILE.jsonl   records an example of every topic, writes its decoded text
// fixture read FILE.mcap               prints the contents of a file, one line per message

namespace {

using namespace recording;

void write(const std::string& mcap, const std::string& lines) {
  test::Capture capture;
  Recorder recorder(mcap, {{5, 6, "robot.xml", "text/xml", "<robot name=\"rig\"/>"}},
                    {.chunk_bytes = 4000, .replace = true});
  std::ofstream expected(lines);
  for (std::uint64_t n = 0; n < 3; ++n)
    test::each_example(n, [&](const auto& m, const std::string& topic, const auto& descriptor) {
      using Wire = typename std::decay_t<decltype(m)>::Wire;
      const TypeDescription type = node::describe(descriptor);
      const std::string schema = ros2msg_text(type);
      const Bytes cdr = capture.bytes_of(descriptor, static_cast<const Wire*>(&m));
      recorder.write(recorder.add_topic(topic, {type.name(), schema, "module erp {};"}),
                     {"writer", 1000 + n, 900 + n, m.sequence, cdr});
      const TypeDescription parsed = parse_ros2msg(type.name(), schema);
      expected << topic << " " << n << " " << to_json(decode_cdr(parsed, cdr)) << "\n";
    });
  recorder.close();
  if (!expected.flush()) throw std::runtime_error("cannot write " + lines);
}

void read(const std::string& mcap) {
  const McapReader reader(mcap);
  std::printf("%s\n", reader.complete() ? "complete" : "cut off");
  for (const auto& attachment : reader.attachments())
    std::printf("%s %s\n", attachment.name.c_str(), attachment.data.c_str());
  reader.for_each([](const Message& message) {
    std::printf("%s %u %s\n", message.channel.topic.c_str(), message.sequence,
                std::string(text(message.data)).c_str());
  });
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 4 && std::string(argv[1]) == "write") return write(argv[2], argv[3]), 0;
    if (argc == 3 && std::string(argv[1]) == "read") return read(argv[2]), 0;
    std::fprintf(stderr, "usage: fixture write FILE.mcap FILE.jsonl | fixture read FILE.mcap\n");
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
