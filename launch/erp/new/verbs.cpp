#include "launch/erp/verbs/verbs.hpp"

#include <iostream>
#include <memory>

#include "launch/erp/new/new_controller.hpp"

namespace launch {

void add_new(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand("new", "Begin something of your own");
  verb->require_subcommand(1);
  auto* controller = verb->add_subcommand("controller", "A project of one controller, with a test");
  auto name = std::make_shared<std::string>();
  auto folder = std::make_shared<std::string>();
  controller->add_option("name", *name, "lower-case words joined by _")->required();
  controller->add_option("dir", *folder, "a folder that is not there yet")->required();
  controller->callback([name, folder, &chosen] {
    chosen = [name, folder] {
      for (const auto& file : new_controller(*name, *folder)) std::cout << file.string() << '\n';
      std::cout << "next: cd " << *folder
                << " && cmake -B build -DCMAKE_PREFIX_PATH=<where erp is installed>"
                   " && cmake --build build && ctest --test-dir build\n";
      return 0;
    };
  });
}

}  // namespace launch
