#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tools/lineshaft/lsp/documents.hpp"
#include "tools/lineshaft/lsp/project.hpp"

namespace lineshaft::lsp {

/// What an editor and the server know of each other.
struct Session {
    std::function<void(const Json&)> send;
    Encoding encoding = Encoding::utf16;
    bool takes_related_information = false;
    Documents documents = {};
    Project project = {};
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
