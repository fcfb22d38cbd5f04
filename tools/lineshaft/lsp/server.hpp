#pragma once

#include <optional>
#include <string>

#include "tools/lineshaft/lsp/session.hpp"

namespace lineshaft::lsp {

/// Answers an editor's messages, as version 3.17 of the Language Server Protocol says.
class Server {
  public:
    explicit Server(std::function<void(const Json&)> send);

    /// A message without its head. Whatever it is, nothing is thrown.
    void receive(const std::string& message);
    /// Does a piece of what nobody waits for. False: there is none.
    bool work() { return diagnosis_.work(); }
    /// 0 behind `shutdown` and `exit`, 1 behind `exit` alone; empty: it goes on.
    std::optional<int> ended() const { return ended_; }

  private:
    enum class Phase : std::uint8_t { fresh, initialized, shut_down };

    void notify(const std::string& method, const Json& params);
    Json answer(const std::string& method, const Json& params);
    Json initialize(const Json& params);
    void fail(const Json& id, int code, const std::string& message);

    Session session_;
    Diagnosis diagnosis_{session_};
    Phase phase_ = Phase::fresh;
    std::optional<int> ended_;
};

}  // namespace lineshaft::lsp
