#include "runtime/debug/protocol.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "runtime/debug/packed_values.hpp"

namespace lineshaft::debug {

Json capabilities() {
    return {{"supportsConfigurationDoneRequest", true},
            {"supportsStepBack", true},
            {"supportsTerminateRequest", true},
            {"supportsConditionalBreakpoints", true},
            {"supportsHitConditionalBreakpoints", true},
            {"supportsLogPoints", true},
            {"supportsFunctionBreakpoints", true},
            {"supportsDataBreakpoints", true},
            {"supportsEvaluateForHovers", true},
            {"supportsSetVariable", true},
            {"exceptionBreakpointFilters",
             {{{"filter", "block_error"}, {"label", "An error of a block"}, {"default", true}}}},
            {"supportTerminateDebuggee", true}};
}

Json source_of(const std::string& path) {
    std::error_code unknown;
    const auto whole = std::filesystem::absolute(path, unknown);
    return {{"name", std::filesystem::path(path).filename().string()},
            {"path", unknown ? path : whole.lexically_normal().string()}};
}

std::vector<Wanted> wanted_in(const Json& arguments, int shift) {
    std::vector<Wanted> wanted;
    for (const Json& each : list_in(arguments, "breakpoints"))
        wanted.push_back({.line = static_cast<int>(number_in(each, "line")) + shift,
                          .condition = text_in(each, "condition"),
                          .hits = text_in(each, "hitCondition"),
                          .log = text_in(each, "logMessage")});
    return wanted;
}

Json breakpoint_as_json(const Breakpoint& breakpoint, const std::string& path, int shift) {
    Json one{{"id", breakpoint.id},
             {"verified", breakpoint.is_verified},
             {"line", breakpoint.line - shift},
             {"source", source_of(path)}};
    if (!breakpoint.is_verified) one["message"] = breakpoint.error;
    return one;
}

Json data_as_json(const std::string& variable, const std::string& name, const std::string& id) {
    if (!id.empty())
        return {{"dataId", id},
                {"description", name.empty() ? variable : name},
                {"accessTypes", {"write"}}};
    const std::string why = fmt::format("'{}' has no place that lasts from scan to scan", variable);
    return {{"dataId", nullptr}, {"description", why}};
}

Written write_by_hand(const Shown& shown, const std::string& value,
                      const std::vector<Frame>& frames, const DataBreakpoints& lasting) {
    const auto why_not = [&](const char* why) {
        return Refused(fmt::format("'{}' {}", shown.name, why));
    };
    if (!shown.seat || frames.empty()) throw why_not("is nothing that can be set");
    const Seat& seat = *shown.seat;
    using Kind = st::Type::Kind;
    if (seat.type->kind == Kind::handle || seat.type->kind == Kind::interface ||
        seat.type->is_reference())
        throw why_not("refers to something, which is not for a debugger to choose");
    if (!seat.type->is_scalar() && seat.type->kind != Kind::text)
        throw why_not("is no value: what it has is set part by part");
    const Shown place{
        .name = {}, .value = {}, .at = seat.packed.type ? seat.packed.bytes : shown.at, .bytes = 1};
    if (lasting.id_of(place, frames).empty())
        throw why_not("has no place that lasts from scan to scan");
    std::string error;
    const Frame& frame = frames.front();
    auto bytes = Expression(value, *frame.mark.file).value_for(*seat.type, frame, error);
    if (!error.empty()) throw Refused(error);
    std::string text = show("", {seat.type, bytes.data(), &frame}).value;
    return {std::move(text), writing(seat, std::move(bytes))};
}

Json set_function_breakpoints(const Json& arguments, SignalConditions& signals) {
    std::vector<std::string> texts;
    for (const Json& each : list_in(arguments, "breakpoints")) {
        const bool has_more = !(text_in(each, "condition") + text_in(each, "hitCondition")).empty();
        texts.push_back(has_more ? "" : text_in(each, "name"));
    }
    Json all = Json::array();
    for (std::string error : signals.set(texts)) {
        if (texts[all.size()].empty())
            error = "the name is the condition, and counts nothing: motor.speed > 20 mm/s";
        all.push_back({{"verified", error.empty()}});
        if (!error.empty()) all.back()["message"] = error;
    }
    return {{"breakpoints", all}};
}

Json set_data_breakpoints(const Json& arguments, DataBreakpoints& data) {
    std::vector<std::string> ids;
    std::vector<std::string> errors;
    for (const Json& each : list_in(arguments, "breakpoints")) {
        const std::string access = text_in(each, "accessType");
        const bool has_more = !(text_in(each, "condition") + text_in(each, "hitCondition")).empty();
        errors.push_back(!access.empty() && access != "write"
                             ? "it stops where the value changes, which is 'write'"
                         : has_more ? "it stops at each change, and counts nothing"
                                    : "");
        ids.push_back(errors.back().empty() ? text_in(each, "dataId") : "");
    }
    Json all = Json::array();
    for (const DataBreakpoints::Placed& placed : data.set(ids)) {
        const std::string& error = errors[all.size()].empty() ? placed.error : errors[all.size()];
        all.push_back({{"verified", error.empty()}});
        if (error.empty())
            all.back()["id"] = placed.number;
        else
            all.back()["message"] = error;
    }
    return {{"breakpoints", all}};
}

}  // namespace lineshaft::debug
