#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runtime/st/library/test_sources.hpp"
#include "tools/lineshaft/check_file.hpp"

namespace lineshaft::lsp {

/// Structured Text, in a file of its own or in TwinCAT's XML, or a project of such.
bool is_code(const std::string& path);

/// The folders that the editor has open, and what in them is checked together: a file of YAML with
/// all that it names, an object of TwinCAT with its project, a source of Structured Text that no
/// program names with those that declare what it names. A file outside of them is checked as if the
/// command line named it alone.
class Project {
  public:
    void set_folders(std::vector<std::string> folders) { folders_ = std::move(folders); }

    /// Files, each of which stands for all that is checked with it, that show what is wrong with
    /// this one: the programs that have it among their sources, else it alone.
    std::vector<std::string> roots_of(const std::string& path);

    /// Says what is wrong, as `lineshaft check` does.
    std::optional<CheckedProgram> check(const std::string& root, Diagnostics& out);

    /// What is compiled together there, a file of tests last.
    std::vector<std::shared_ptr<const SourceFile>> sources_of(const std::string& root);

    /// Every root below the folders with that word in what belongs to it, and those of `path`.
    std::vector<std::string> roots_to_look_in(const std::string& path, const std::string& word);

    /// The text of a file is another one; files have come or gone.
    void change(const std::string& path);
    void forget();

  private:
    bool lies_in_folders(const std::string& path) const;
    void read_folders();
    void index(const std::string& program);
    /// Reads the folder's sources if it must.
    const st::SourcePool& pool();
    /// The `.plcproj` in a folder above, else the object alone.
    std::string project_of(const std::string& object) const;

    std::vector<std::string> folders_;
    bool is_read_ = false, has_pool_ = false;
    std::set<std::string> yaml_files_, sources_, projects_;
    std::map<std::string, std::set<std::string>> programs_;  ///< and paths of their sources
    st::SourcePool pool_;
};

}  // namespace lineshaft::lsp
