#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

namespace lineshaft::debug {

using Json = nlohmann::ordered_json;

/// Messages of the Debug Adapter Protocol over two descriptors: a head of lines, of which
/// `Content-Length` says how many bytes of JSON follow. A thread of its own reads; what is sent is
/// sent by one thread.
class Messages {
  public:
    Messages(int in, int out);
    ~Messages();
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    /// Waits for the next one. Empty when the other side has gone, or what came was none.
    std::optional<Json> next();

    /// Whether next() need not wait. Costs a load.
    bool waits() const { return waiting_ > 0; }

    void send(const Json& message);

  private:
    void read_all();
    bool read_some();
    std::optional<std::string> take_body();

    int in_, out_, wake_;
    std::string bytes_;  ///< read, and not taken yet
    std::deque<Json> messages_;
    std::atomic<std::size_t> waiting_ = 0;
    bool ended_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::thread thread_;
};

}  // namespace lineshaft::debug
