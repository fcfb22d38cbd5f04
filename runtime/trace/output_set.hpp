#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/trace/output_file.hpp"

namespace lineshaft {

/// The files of one run, which appear under their names together: none if one of them cannot be
/// written, and when several processes write the same files at once, all of the last one. A folder
/// is locked (flock) while files get their names in it. Sidecars of before go first and the others
/// come last: whenever this is killed, none tells of another file.
class OutputSet {
  public:
    /// Unless it flushes, the files are with the operating system only when they have their names:
    /// who makes many sets calls flush_file_system() behind the last.
    explicit OutputSet(bool flushes = true) : flushes_(flushes) {}

    /// Takes a file to which all has been written, with the text of the sidecar that will stand
    /// beside it; empty: none does. Devices and pipes have none.
    void add(std::unique_ptr<OutputFile> file, std::string sidecar = {});

    /// False when any step failed: see error().
    bool commit();

    /// For a run that goes on later: restore() takes the files up that were there at save(), if
    /// they are among `known`: no others are touched.
    void save(StateWriter& out);
    void restore(StateReader& in, const std::vector<std::string>& known);

    /// What is wrong with the first file that went wrong; empty while all is well.
    const std::string& error() const { return error_; }

  private:
    struct Entry {
        std::unique_ptr<OutputFile> file;
        std::string sidecar;
    };

    bool check(const OutputFile& file);
    void complete(OutputFile& file);
    bool publish(std::vector<std::unique_ptr<OutputFile>>& sidecars);

    bool flushes_;
    std::vector<Entry> entries_;
    std::string error_;
};

}  // namespace lineshaft
