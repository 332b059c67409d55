// Target: arbitrary bytes as a recording. It is read message by message, as a table and as CSV of
// each topic, and it is recovered.
#include <set>
#include <sstream>

#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/table.hpp"
#include "interfaces/recording/topic_csv.hpp"
#include "tests/fuzz/input.hpp"

namespace {

/// Runs `attempt`. A RecordingError is accepted: it is the documented reaction to a damaged file.
template <class Attempt>
void accept_rejection(Attempt&& attempt) {
  try {
    attempt();
  } catch (const recording::RecordingError&) {
  }
}

void read(const std::string& file) {
  const recording::McapReader reader(file);
  std::uint64_t messages = 0;
  reader.for_each([&](const recording::Message&) { ++messages; });
  fuzz::require(messages == reader.contents().messages, "every counted message is read");
  std::set<std::string> topics;
  for (const auto& [id, channel] : reader.channels()) topics.insert(channel.topic);
  for (const std::string& topic : topics)
    accept_rejection([&] {
      std::ostringstream out;
      recording::write_topic_csv(reader, topic, out);
    });
}

void recover(const std::string& file, const std::string& recovered_file) {
  std::filesystem::remove(recovered_file);
  const recording::Recovered recovered = recording::recover(file, recovered_file);
  const recording::McapReader reader(recovered_file);
  fuzz::require(reader.complete(), "a recovered file is complete");
  fuzz::require(reader.contents().messages == recovered.messages,
                "a recovered file has all recovered messages");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  const std::string file = folder.write("run", data, size);
  recording::TableOptions options;
  options.sequences = options.lines = options.targets = true;
  accept_rejection([&] { recording::read_table(file, options); });
  accept_rejection([&] { read(file); });
  accept_rejection([&] { recover(file, folder / "recovered.mcap"); });
  return 0;
}
