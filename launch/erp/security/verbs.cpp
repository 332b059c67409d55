#include "launch/erp/verbs/verbs.hpp"

#include <iostream>
#include <memory>

#include "launch/erp/security/security.hpp"

namespace launch {

void add_security(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand("security", "Access control of a robot by DDS Security");
  verb->require_subcommand(1);
  auto* make = verb->add_subcommand(
      "make", "Create a certificate authority, and an identity for each role of a process");
  auto folder = std::make_shared<std::string>();
  auto days = std::make_shared<int>(730);
  make->add_option("dir", *folder, "new folder")->required();
  make->add_option("--days", *days, "validity of the certificates, days")
      ->check(CLI::Range(1, 36500))
      ->capture_default_str();
  make->callback([folder, days, &chosen] {
    chosen = [folder, days] {
      for (const auto& file : make_security(*folder, valid_for_days(*days)))
        std::cout << file.string() << '\n';
      std::cout << "next: erp launch GRAPH.xml --security " << *folder
                << "; in other terminals: export ERP_SECURITY=" << *folder
                << ", or one of the folders in " << *folder << "/roles, for fewer rights\n";
      return 0;
    };
  });
}

}  // namespace launch
