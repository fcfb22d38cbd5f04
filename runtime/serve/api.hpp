#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "runtime/serve/desk.hpp"
#include "runtime/serve/live.hpp"

namespace lineshaft {

struct ApiRequest {
    std::multimap<std::string, std::string> query;
    nlohmann::ordered_json body;  ///< null: none

    std::string parameter(const std::string& name) const;  ///< empty: not given
};

/// A status of HTTP, and what is told; or a file, or a stream of samples.
struct ApiReply {
    int status = 200;
    nlohmann::ordered_json body;
    std::string file = {};
    std::shared_ptr<Stream> stream = nullptr;
    std::string allow = {};  ///< of 405: the methods that there are
};

class Api;

/// One thing that clients can ask for. The table of these is the only place where it is declared:
/// requests are handed out by it, and the OpenAPI document is made from it.
struct Route {
    std::string_view method, path, doc;
    bool writes;                         ///< changes something: only with --allow-write
    nlohmann::ordered_json parameters;   ///< of the query: names and what they are
    nlohmann::ordered_json body, reply;  ///< as JSON schemas; null: none
    ApiReply (Api::*call)(const ApiRequest&);
    std::string_view type = "application/json";  ///< of the reply
};

std::span<const Route> routes();

/// The OpenAPI 3.0 document of routes().
nlohmann::ordered_json openapi();

/// Answers requests of any thread: asks the machine's thread through its mailbox.
class Api {
  public:
    /// `save` makes a checkpoint; in the machine's thread.
    Api(Live& live, Desk& desk, Loaded& loaded, std::function<std::string()> save)
        : live_(live), desk_(desk), loaded_(loaded), save_(std::move(save)) {}

    ApiReply state(const ApiRequest&);
    ApiReply signals(const ApiRequest&);
    ApiReply values(const ApiRequest&);
    ApiReply stream(const ApiRequest&);
    ApiReply set(const ApiRequest&);
    ApiReply force(const ApiRequest&);
    ApiReply lift_force(const ApiRequest&);
    ApiReply pause(const ApiRequest&);
    ApiReply resume(const ApiRequest&);
    ApiReply step(const ApiRequest&);
    ApiReply run_until(const ApiRequest&);
    ApiReply speed(const ApiRequest&);
    ApiReply checkpoint(const ApiRequest&);
    ApiReply document(const ApiRequest&);

  private:
    template <class Job>
    ApiReply ask(Job job);
    template <class Job>
    ApiReply after(Job job);
    ApiReply change(Change::Kind kind, const std::vector<Wanted>& wanted);
    std::vector<const Signal*> named(const ApiRequest& request, Diagnostics& out);

    Live& live_;
    Desk& desk_;
    Loaded& loaded_;
    std::function<std::string()> save_;
};

/// `{"error": message, "help": ..., "code": ...}`
ApiReply failure(int status, std::string message, std::string help = {}, std::string code = {});

}  // namespace lineshaft
