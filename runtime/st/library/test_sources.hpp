#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft::st {

/// True if a TEST stands in it.
bool is_test_file(const std::shared_ptr<const SourceFile>& file);

/// Sources among which files of tests find what they test.
class SourcePool {
  public:
    /// A file, once; a file of tests is none of the sources.
    void add(const std::shared_ptr<const SourceFile>& file);
    /// What stands in a file now, in place of what stood there.
    void replace(const std::shared_ptr<const SourceFile>& file);

    /// Those of TcUnit's own project, where it stands beside what is tested by it: the library of
    /// that name is meant.
    void leave_out_tcunit();

    /// What `tests` needs: `x.st` of the same folder for `test_x.st` and `x_test.st`, and then
    /// every file that declares a name which the tests or a file found so far use and do not
    /// declare. Of several that declare it the nearest, by path, one for each namespace that has
    /// it; of B&R's a `.fun` and the bodies beside it together. So files that tests do not name
    /// may hold whatever they like, and two that declare the same do not meet.
    std::vector<std::shared_ptr<const SourceFile>> needed_by(
        const std::shared_ptr<const SourceFile>& tests) const;
    /// Every file that declares one of the names, or one which a file found so far uses.
    std::vector<std::shared_ptr<const SourceFile>> needed_by(
        const std::vector<std::string>& names) const;

  private:
    /// Names in small letters.
    struct Entry {
        std::shared_ptr<const SourceFile> file;
        /// Declared blocks and types: `T`, `b.T` and `a.b.T`, each with the last.
        std::multimap<std::string, std::string> types;
        std::set<std::string> spaces;      ///< namespaces whose names it may write without them
        std::set<std::string> usings;      ///< of a project: namespaces that it says it uses
        std::set<std::string> own_spaces;  ///< namespaces that it has something in
        std::set<std::string> values;      ///< declared globals and values of enumerations
        std::set<std::string> own;         ///< variables and members, which hide others' values
        std::set<std::string> used;        ///< other than as types
        std::set<std::string> used_types;
    };
    static Entry entry_of(const std::shared_ptr<const SourceFile>& file);
    void note(std::size_t entry);
    /// Leaves out those of which `is_left` is true.
    void leave_out(const std::function<bool(const Entry&)>& is_left);
    void follow(std::vector<const Entry*>& chosen, const std::string& to) const;
    static std::vector<std::shared_ptr<const SourceFile>> files_of(
        const std::vector<const Entry*>& chosen);
    std::vector<const Entry*> nearest(const std::string& name, const Entry& user,
                                      const std::string& to) const;
    const Entry* nearest_value(const std::string& name, const std::string& to) const;

    std::vector<Entry> entries_;
    /// Which of them declare a type or a value of that name, from the first on.
    std::unordered_map<std::string, std::vector<std::size_t>> with_type_, with_value_;
};

}  // namespace lineshaft::st
