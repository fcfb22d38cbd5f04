#include "tests/runtime/st/instance.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <span>
#include <sstream>

#include <fmt/format.h>

#include "runtime/source/encoding.hpp"

namespace lineshaft::st {

std::shared_ptr<const SourceFile> read(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return std::make_shared<const SourceFile>(
        SourceFile{path.substr(path.rfind('/') + 1), as_utf8(text.str())});
}

std::shared_ptr<const SourceFile> source(std::string text) {
    return std::make_shared<const SourceFile>(SourceFile{"job.st", std::move(text)});
}

namespace {

constexpr std::array<std::uint64_t, 4> guard{0x5afe5afe5afe5afe, 1, ~0ULL, 0x0123456789abcdef};

}  // namespace

Instances::Instances(const Library& library) : library_(library) {
    for (const BlockType& kind : library.kinds()) {
        memory_.emplace_back(guard.size() + kind.size / 8 + guard.size());
        std::ranges::copy(guard, memory_.back().begin());
        std::ranges::copy(guard, memory_.back().end() - std::ssize(guard));
        places_.push_back(reinterpret_cast<std::byte*>(memory_.back().data() + guard.size()));
        kind.construct(places_.back());
    }
    for (std::size_t i = 0; i < places_.size(); ++i)
        for (const Field& field : library.kinds()[i].fields)
            for (std::size_t k = 0; k < places_.size(); ++k)
                if (field.direction == Direction::in_out && library.kinds()[k].name == field.refers)
                    store(lineshaft::Type::integer, places_[i] + field.offset,
                          static_cast<std::int64_t>(k));
}

bool Instances::is_scanned(const BlockType& kind) const {
    const auto is_program = [](const BlockType& one) { return one.doc.starts_with("PROGRAM"); };
    return is_program(kind) || std::ranges::none_of(library_.kinds(), is_program);
}

void Instances::scan(std::int64_t time, std::int64_t interval) {
    const Scan now{time, interval, interval == 0 ? 0 : time / interval};
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const BlockType& kind = library_.kinds()[i];
        if (is_scanned(kind))
            kind.scan_blocks(places_[i], 1, now,
                             {.kind = kind.context,
                              .instances = places_.data(),
                              .blocks = static_cast<int>(places_.size())});
    }
}

bool Instances::is_guarded() const {
    return std::ranges::all_of(memory_, [](const std::vector<std::uint64_t>& memory) {
        return std::ranges::equal(guard, std::span(memory).first(guard.size())) &&
               std::ranges::equal(guard, std::span(memory).last(guard.size()));
    });
}

std::vector<std::string> Instances::faults() const {
    std::vector<std::string> found;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const FaultPlace fault = library_.fault(library_.kinds()[i], places_[i]);
        if (fault.fault != Fault::none)
            found.push_back(fmt::format("{} {}", fault.mark.line,
                                        fault_names[static_cast<std::size_t>(fault.fault)]));
    }
    return found;
}

std::string Instances::text(const std::string& name) const {
    for (const bool scanned : {true, false})
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (is_scanned(library_.kinds()[i]) != scanned) continue;
            for (const Field& field : library_.kinds()[i].fields)
                if (field.direction != Direction::in_out && same_name(field.name, name))
                    return describe(load(field.type, places_[i] + field.offset), field.type,
                                    field.names, {});
        }
    return "no such field";
}

}  // namespace lineshaft::st
