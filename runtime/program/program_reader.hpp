#pragma once

#include <map>
#include <memory>
#include <string>

#include "runtime/program/program.hpp"

namespace lineshaft {

/// A parameter's text in force, and where a study sets it.
struct ParameterValue {
    Node node;
    Mark set_at;
};

using ParameterValues = std::map<std::string, ParameterValue>;

/// Makes a Program of a file, see read_program(): parameters are replaced and the controller's
/// tasks read before the form is; then what needs all of it, or other files.
class ProgramReader {
  public:
    ProgramReader(const LoadOptions& options, Diagnostics& out) : options_(options), read_(out) {}

    Program read(std::shared_ptr<const SourceFile> file);

  private:
    std::optional<Node> parse(const std::shared_ptr<const SourceFile>& file) const;
    void parameters(const Node& root);
    void settings(ParameterValues& values);
    void controller(const Node& node);
    void check_attached(const Node& task) const;
    void find_file(ReplayPlan& replay) const;
    void force(const std::string& text);

    const LoadOptions& options_;
    Reader read_;
    Program program_;
    ParameterValues values_;
};

}  // namespace lineshaft
