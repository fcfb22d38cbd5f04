#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "runtime/source/input_file.hpp"

/// What the protocols of editors, DAP and LSP, are said in: JSON behind lines of a head, of which
/// `Content-Length` counts the bytes that follow behind an empty line.
namespace lineshaft {

using Json = nlohmann::ordered_json;

/// Cuts bytes into messages.
class Frames {
  public:
    static constexpr std::size_t longest_head = 4096, longest_body = std::size_t{64} << 20;

    void add(std::string_view bytes) { bytes_ += bytes; }

    /// The next message that is there as a whole, without its head. What is no head, or says a
    /// length beyond `longest_body`, is left out.
    std::optional<std::string> take();

    bool has_one();

    std::size_t size() const { return bytes_.size(); }  ///< not taken yet [bytes]

  private:
    std::string bytes_;
    std::size_t head_ = 0, body_ = 0;  ///< of the next one [bytes]; no head: not known yet
};

/// What is there under a key; `otherwise`, or an empty list, where nothing of that type is.
std::string text_in(const Json& from, const char* key, const std::string& otherwise = {});
std::int64_t number_in(const Json& from, const char* key, std::int64_t otherwise = 0);
bool flag_in(const Json& from, const char* key, bool otherwise = false);
Json list_in(const Json& from, const char* key);

/// A message with its head. Bytes of texts that are no UTF-8 are replaced.
std::string framed(const Json& message);

/// Messages over two descriptors, which stay open. One thread.
class Messages {
  public:
    Messages(int in, int out) : input_(in), in_(in), out_(out) {}

    /// Waits for the next one. Empty when nothing more comes, or `interrupt_requested`.
    std::optional<std::string> next();

    /// Whether next() need not wait.
    bool waits();

    /// What the other side does not take any more is lost.
    void send(const Json& message);

  private:
    bool read_some();

    InputFile input_;
    Frames frames_;
    int in_, out_;
};

}  // namespace lineshaft
