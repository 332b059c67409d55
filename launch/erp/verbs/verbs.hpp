#pragma once
#include <CLI/CLI.hpp>
#include <functional>

/// The families of verbs. Each function adds its verbs to `app`. Parsing a verb sets `chosen`.
namespace launch {

/// Function that executes the chosen verb; returns the exit code.
using Chosen = std::function<int()>;

void add_launch(CLI::App& app, Chosen& chosen);
void add_check(CLI::App& app, Chosen& chosen);
void add_help(CLI::App& app, Chosen& chosen);
void add_command(CLI::App& app, Chosen& chosen);     ///< send, set, stop
void add_doctor(CLI::App& app, Chosen& chosen);
void add_graph_view(CLI::App& app, Chosen& chosen);  ///< ps, ls, graph
void add_topic_view(CLI::App& app, Chosen& chosen);  ///< hz, echo, delay
void add_log(CLI::App& app, Chosen& chosen);
void add_model(CLI::App& app, Chosen& chosen);
void add_gap(CLI::App& app, Chosen& chosen);
void add_calibrate(CLI::App& app, Chosen& chosen);
void add_learn(CLI::App& app, Chosen& chosen);
void add_new(CLI::App& app, Chosen& chosen);
void add_security(CLI::App& app, Chosen& chosen);

}  // namespace launch
