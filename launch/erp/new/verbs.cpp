#include "launch/erp/verbs/verbs.hpp"

#include <iostream>
#include <memory>

#include "launch/erp/new/new_controller.hpp"

namespace launch {

void add_new(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand("new", "Create a project from a template");
  verb->require_subcommand(1);
  auto* controller =
      verb->add_subcommand("controller", "Create a project of one controller with a test");
  auto name = std::make_shared<std::string>();
  auto folder = std::make_shared<std::string>();
  controller->add_option("name", *name, "name: lower-case words joined by _")->required();
  controller->add_option("dir", *folder, "new folder")->required();
  controller->callback([name, folder, &chosen] {
    chosen = [name, folder] {
      for (const auto& file : new_controller(*name, *folder)) std::cout << file.string() << '\n';
      std::cout << "next: cd " << *folder
                << " && cmake -B build -DCMAKE_PREFIX_PATH=<install prefix of erp>"
                   " && cmake --build build && ctest --test-dir build\n";
      return 0;
    };
  });
}

}  // namespace launch
