#include "launch/erp/gap/truth.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cmath>
#include <filesystem>

#include "launch/erp/gap/former_keys.hpp"
#include "launch/erp/gap/gap.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"

namespace launch::gap {

std::string sha256(const std::string& text) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  EVP_Digest(text.data(), text.size(), digest, &length, EVP_sha256(), nullptr);
  std::string hex;
  for (unsigned int k = 0; k < length; ++k) hex += fmt::format("{:02x}", digest[k]);
  return hex;
}

std::optional<double> closed_by_truth(const std::string& folder,
                                      const nlohmann::ordered_json& truth) {
  namespace diagnosis = sim::diagnosis;
  namespace effects = sim::effects;
  std::vector<effects::Placed> hidden;
  for (const auto& effect : truth["hidden"]) {
    const auto neutral = effects::neutral(effect["type"].get<std::string>());
    if (!neutral || effects::about(*neutral).stage == effects::Stage::bus) return {};
    effects::Placed placed{effect["on"], *neutral};
    for (const effects::Parameter& p : effects::parameters(placed.effect))
      if (effect["parameters"].contains(p.name)) *p.value = effect["parameters"][p.name];
    hidden.push_back(placed);
  }
  const erp::Robot robot = erp::read_robot(folder + "/robot.xml");
  const std::string case_folder = folder + "/" + truth["case"].get<std::string>();
  const std::string file = case_folder + "/diagnosis.json";
  const auto d = parse_diagnosis<nlohmann::ordered_json>(read_text(file), file);
  std::vector<std::string> files;  // the paths in the diagnosis may be relative to another folder
  for (const auto& name : d["held_out"])
    files.push_back(case_folder + "/" +
                    std::filesystem::path(name.get<std::string>()).filename().string());
  auto episodes = read_episodes(robot, files).episodes;
  const auto held_out_from_s = d.value("held_out_from_s", nlohmann::ordered_json::object());
  for (std::size_t k = 0; k < episodes.size(); ++k)
    if (const auto name = d["held_out"][k].get<std::string>(); held_out_from_s.contains(name))
      episodes[k].judge_from(held_out_from_s[name].get<double>());
  const diagnosis::Evaluator evaluator(robot, std::move(episodes));
  std::vector<std::size_t> all_episodes(files.size());
  for (std::size_t k = 0; k < all_episodes.size(); ++k) all_episodes[k] = k;
  const auto rms = [](const diagnosis::ScoreBlock& block) {
    return std::sqrt(block.square / static_cast<double>(std::max<std::size_t>(1, block.windows)));
  };
  const double error_before =
      rms(sum(evaluator.blocks(evaluator.nominal_evaluation(), all_episodes)));
  const double error_after =
      rms(sum(evaluator.blocks(evaluator.with(hidden, all_episodes), all_episodes)));
  return error_before > 1 ? (error_before - error_after) / (error_before - 1) : 0;
}

}  // namespace launch::gap
