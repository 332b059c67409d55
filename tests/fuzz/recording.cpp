// Any bytes as a recording: walked, read by time, as a table, as a topic's CSV, and mended.
#include <set>
#include <sstream>

#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/table.hpp"
#include "interfaces/recording/topic_csv.hpp"
#include "tests/fuzz/input.hpp"

namespace {

/// A refusal with place and remedy is what damage calls for; anything else is a find.
template <class Try>
void may_refuse(Try&& attempt) {
  try {
    attempt();
  } catch (const recording::RecordingError&) {
  }
}

void read(const std::string& file) {
  const recording::McapReader reader(file);
  std::uint64_t messages = 0;
  reader.for_each([&](const recording::Message&) { ++messages; });
  fuzz::require(messages == reader.contents().messages, "every message that was counted is read");
  std::set<std::string> topics;
  for (const auto& [id, channel] : reader.channels()) topics.insert(channel.topic);
  for (const std::string& topic : topics)
    may_refuse([&] {
      std::ostringstream out;
      recording::write_topic_csv(reader, topic, out);
    });
}

void mend(const std::string& file, const std::string& mended) {
  std::filesystem::remove(mended);
  const recording::Recovered recovered = recording::recover(file, mended);
  const recording::McapReader reader(mended);
  fuzz::require(reader.complete(), "what was mended is whole");
  fuzz::require(reader.contents().messages == recovered.messages, "and has what was recovered");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  const std::string file = folder.write("run", data, size);
  recording::TableOptions all;
  all.sequences = all.lines = all.targets = true;
  may_refuse([&] { recording::read_table(file, all); });
  may_refuse([&] { read(file); });
  may_refuse([&] { mend(file, folder / "mended.mcap"); });
  return 0;
}
