#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "runtime/program/program.hpp"
#include "runtime/program/substitution.hpp"
#include "runtime/projects/solution.hpp"

namespace lineshaft {

/// Makes a Program of a file, see read_program(): parameters are replaced and the controller's
/// tasks read before the form is; then what needs all of it, or other files.
class ProgramReader {
  public:
    ProgramReader(const LoadOptions& options, Diagnostics& out) : options_(options), read_(out) {}

    Program read(std::shared_ptr<const SourceFile> file);

  private:
    /// A file of another tool that is not read, and one of another name that does not say to be a
    /// program: what to do with it is told.
    bool refuse_foreign(const std::shared_ptr<const SourceFile>& file);
    std::optional<Node> parse(const std::shared_ptr<const SourceFile>& file) const;
    void parameters(const Node& root, Substitution& substitution);
    void unused_parameters(const Node& root, const std::set<std::string>& used);
    void settings(ParameterValues& values);
    void controller(const Node& node);
    std::optional<std::string> named_controller(const Node& node) const;
    void check_attached(const Node& task) const;
    void find_file(ReplayPlan& replay) const;
    void note_project(const Node& named);
    void find_source(const Node& named);
    std::string namespace_of(const std::string& path);
    void read_source_file(const std::string& path, const Mark& mark);
    void force(const std::string& text);
    void settle_dialect();
    void recording();

    const LoadOptions& options_;
    Reader read_;
    Program program_;
    ParameterValues values_;
    std::vector<projects::ProjectNames> projects_;  ///< of the `.plcproj` that were read
};

}  // namespace lineshaft
