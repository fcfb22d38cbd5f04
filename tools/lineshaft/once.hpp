#pragma once

#include <set>
#include <string>

#include <fmt/format.h>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// Tells once what several programs find in a source that they share.
class Once {
  public:
    explicit Once(Diagnostics& out) : out_(out) {}
    void add(const Diagnostics& found) {
        for (const Diagnostic& d : found.list())
            if (is_new(d)) out_.add(d.code, d.mark, d.message, d.help);
        for (const Diagnostic& d : found.warnings())
            if (is_new(d)) out_.warn(d.code, d.mark, d.message, d.help);
    }

  private:
    bool is_new(const Diagnostic& d) {
        const std::string path = d.mark.file ? d.mark.file->path : "";
        return told_
            .insert(fmt::format("{}:{}:{}: {}", path, d.mark.line, d.mark.column, d.message))
            .second;
    }

    Diagnostics& out_;
    std::set<std::string> told_;
};

}  // namespace lineshaft
