#pragma once

#include <map>
#include <mutex>

#include "runtime/serve/address.hpp"
#include "runtime/serve/api.hpp"
#include "runtime/serve/http_session.hpp"

namespace lineshaft {

struct GuardOptions {
    bool allow_write = false;
    std::string token = {};             ///< that clients of other machines need for writing
    std::int64_t most_requests = 1000;  ///< a second, of a machine; and of who holds the token
};

/// Decides who may do what. For any thread.
class Guard {
  public:
    /// `tell` is given sentences for a person.
    Guard(const GuardOptions& options, World& world, std::function<void(const std::string&)> tell)
        : options_(options), world_(world), tell_(std::move(tell)) {}

    /// What is answered instead: L0513 of another host or origin, of a wrong token, of writing that
    /// is not allowed; 429 for too many requests a second. Empty when it may come in. A wrong token
    /// takes the longer the more of them have come from that machine; the right one never does.
    std::optional<ApiReply> refuse(const Visitor& visitor, bool writes);

    /// Whether this is a refusal of which there may be too many to be written down one by one.
    static bool is_of_many(const ApiReply& reply) { return reply.status == 429; }

  private:
    enum class Token : std::uint8_t { none, right, wrong };

    bool is_known(const std::string& host) const;
    Token token_of(const Visitor& visitor) const;
    bool is_too_much(const std::string& of_whom);
    void slow_down(const std::string& peer);

    const GuardOptions& options_;
    World& world_;
    const std::function<void(const std::string&)> tell_;
    std::mutex mutex_;
    std::int64_t second_ = 0;
    std::map<std::string, std::int64_t> requests_;  ///< in this second
    std::map<std::string, int> wrong_;              ///< tokens, by machine
};

}  // namespace lineshaft
