#include "runtime/serve/audit.hpp"

#include <chrono>

#include <fmt/chrono.h>
#include <nlohmann/json.hpp>

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

/// What the wall's clock says, to the millisecond.
std::string date() {
    using namespace std::chrono;
    const auto now = floor<milliseconds>(system_clock::now());
    const auto ms = now.time_since_epoch().count() % 1000;
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(system_clock::to_time_t(now)),
                       ms);
}

}  // namespace

Audit::Audit(World& world, std::string path) : path_(std::move(path)) {
    int error = 0;
    file_ = world.open(path_, true, error);
    if (file_ && error == 0) error = file_->lock();
    if (file_ && error == 0) error = file_->truncate(file_->size());
    if (error != 0) error_ = cannot_write(path_, error);
}

std::string Audit::error() const {
    const std::lock_guard lock(mutex_);
    return error_;
}

void Audit::note(const AuditEntry& entry) {
    constexpr std::size_t most = 1000;
    Json line{{"date", date()},
              {"peer", entry.peer},
              {"by", entry.by},
              {"asked", entry.asked.substr(0, most)},
              {"answer", entry.answer}};
    if (entry.at != never) line["time_ns"] = entry.at;
    const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    const std::lock_guard lock(mutex_);
    std::size_t written = 0;
    const int error = file_ ? file_->append(text, written) : 0;
    if (error != 0) error_ = cannot_write(path_, error);
}

}  // namespace lineshaft
