#pragma once

#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace lineshaft::lsp {

using Json = nlohmann::json;

/// Messages as the base protocol frames them: lines of a head, of which `Content-Length` counts the
/// bytes that follow behind an empty line.
class Frames {
  public:
    void add(std::string_view bytes) { bytes_ += bytes; }
    /// The next message that is there as a whole. What is no head is left out.
    std::optional<std::string> take();
    bool has_one() const;

  private:
    struct Head {
        std::size_t bytes = 0;  ///< of the head, the empty line included
        std::optional<std::size_t> length = {};
    };
    std::optional<Head> head() const;

    std::string bytes_;
};

/// A message with its head.
std::string framed(const Json& message);

/// Reads messages of a descriptor and gives each to `receive`; while none waits, `work` has a piece
/// of work done, false for no work. Until `is_ended`, or nothing more comes.
void serve(int descriptor, const std::function<void(const std::string&)>& receive,
           const std::function<bool()>& work, const std::function<bool()>& is_ended);

}  // namespace lineshaft::lsp
