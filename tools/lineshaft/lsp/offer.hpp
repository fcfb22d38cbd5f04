#pragma once

#include <set>
#include <string>

#include "runtime/source/letters.hpp"
#include "tools/lineshaft/lsp/positions.hpp"

namespace lineshaft::lsp {

/// What something is that can be written: kinds of items of the protocol.
enum class Offered : std::uint8_t {
    method = 2,
    function = 3,
    field = 5,
    variable = 6,
    class_ = 7,
    property = 10,
    unit = 11,
    value = 12,
    enum_ = 13,
    keyword = 14,
    enum_member = 20
};

/// What can be written at a place, each name once.
class Offer {
  public:
    /// Units mHz and MHz are two; n and N are one in Structured Text.
    explicit Offer(bool capitals_count) : capitals_count_(capitals_count) {}

    void add(std::string_view label, Offered kind, std::string_view detail = {},
             std::string_view doc = {}, std::string insert = {}) {
        if (!seen_.insert(capitals_count_ ? std::string(label) : lower(label)).second) return;
        Json item{{"label", label}, {"kind", static_cast<int>(kind)}};
        if (!detail.empty()) item["detail"] = detail;
        if (!doc.empty()) item["documentation"] = doc;
        if (!insert.empty()) item["insertText"] = std::move(insert);
        list_.push_back(std::move(item));
    }
    Json take() { return std::move(list_); }

  private:
    bool capitals_count_;
    std::set<std::string> seen_;
    Json list_ = Json::array();
};

}  // namespace lineshaft::lsp
