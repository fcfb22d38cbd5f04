#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/lineshaft/lsp/documents.hpp"
#include "tools/lineshaft/lsp/project.hpp"

namespace lineshaft::lsp {

struct Meaning;

/// What an editor and the server know of each other.
struct Session {
    std::function<void(const Json&)> send;
    Encoding encoding = Encoding::utf16;
    bool takes_related_information = false;
    Documents documents = {};
    Project project = {};
    /// By root, of the texts as they are now.
    std::map<std::string, std::shared_ptr<const Meaning>> meanings = {};
    /// Likewise, as they last were understood as a whole: what is half-written is lost to the
    /// others.
    std::map<std::string, std::shared_ptr<const Meaning>> whole_meanings = {};
    /// Where none was whole: without the lines that have mistakes.
    std::map<std::string, std::shared_ptr<const Meaning>> mended_meanings = {};
    /// Programs as they last could be read with their sources, by path.
    std::map<std::string, std::shared_ptr<const CheckedProgram>> programs = {};
};

/// What is wrong with the files that are open, told file by file as the editor wants it.
class Diagnosis {
  public:
    explicit Diagnosis(Session& session) : session_(session) {}

    /// This file, which is open, is another one than before: it is checked first.
    void change(const std::string& path);
    void close(const std::string& path);
    /// Checks what is most urgent. False: all has been checked.
    bool work();

  private:
    using Found = std::map<std::string, std::vector<Diagnostic>>;  ///< by path

    void check(const std::string& root);
    void publish(const std::string& path);

    Session& session_;
    std::deque<std::string> waiting_;        ///< roots
    std::map<std::string, Found> found_;     ///< by root
    std::map<std::string, Json> told_ = {};  ///< by path
};

/// As the protocol has it.
Json to_json(const Session& session, const Diagnostic& diagnostic);

}  // namespace lineshaft::lsp
