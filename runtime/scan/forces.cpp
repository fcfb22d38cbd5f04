#include "runtime/scan/forces.hpp"

#include <algorithm>
#include <cstring>

#include "runtime/model/kept_state.hpp"

namespace lineshaft {

Forces::Forces(std::vector<Force>& forces) : forces_(forces) {
    look_ahead(-1);
}

void Forces::update(std::int64_t now, EventSink* events) {
    const auto tell = [&](const Force& force, const char* what) {
        if (events)
            events->happened({.time = now, .kind = EventKind::force, .text = force.text() + what});
    };
    for (std::size_t i = 0; i < forces_.size(); ++i) {
        if (!own_[i].active || forces_[i].until > now) continue;
        end(i);
        tell(forces_[i], " ends");
    }
    for (std::size_t i = 0; i < forces_.size(); ++i) {
        if (own_[i].active || forces_[i].from > now || forces_[i].until <= now) continue;
        begin(i);
        tell(forces_[i], "");
    }
    look_ahead(now);
}

void Forces::look_ahead(std::int64_t now) {
    next_ = never;
    own_.resize(forces_.size());
    active_ = std::ranges::any_of(own_, &Own::active);
    for (const Force& force : forces_)
        for (const std::int64_t time : {force.from, force.until})
            if (time > now && force.from < force.until) next_ = std::min(next_, time);
}

void Forces::forget_ended(std::int64_t now) {
    own_.resize(forces_.size());
    for (std::size_t i = forces_.size(); i-- > 0;) {
        const Force& force = forces_[i];
        if (own_[i].active || force.until > std::max(now, force.from)) continue;
        forces_.erase(forces_.begin() + static_cast<std::ptrdiff_t>(i));
        own_.erase(own_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    look_ahead(now);
}

void Forces::restore(StateReader& in) {
    in.get(own_);
    const auto is_value = [](Type type, const std::byte* bytes) {
        return type != Type::boolean || read<unsigned char>(bytes) <= 1;
    };
    for (std::size_t i = 0; i < own_.size(); ++i)
        in.require(are_booleans(own_[i].active) && is_value(forces_[i].type, own_[i].live) &&
                       is_value(forces_[i].type, own_[i].published),
                   "a forced value");
    if (!in.ok()) own_.assign(forces_.size(), {});
}

void Forces::begin(std::size_t index) {
    const Force& force = forces_[index];
    Own& own = own_[index];
    own.active = true;
    std::memcpy(own.live, force.live, size_of(force.type));
    store(force.type, force.live, force.value);
    if (!force.published) return;
    std::memcpy(own.published, force.published, size_of(force.type));
    store(force.type, force.published, force.value);
}

void Forces::end(std::size_t index) {
    const Force& force = forces_[index];
    Own& own = own_[index];
    own.active = false;
    if (force.stays) return;
    std::memcpy(force.live, own.live, size_of(force.type));
    if (force.published) std::memcpy(force.published, own.published, size_of(force.type));
}

void Forces::exchange(const std::byte* block, bool outputs, Way way) {
    for (std::size_t i = 0; i < forces_.size(); ++i) {
        const Force& force = forces_[i];
        if (!own_[i].active || force.block != block || force.is_output != outputs) continue;
        if (way == Way::lift) {
            if (force.stays) continue;
            std::memcpy(force.live, own_[i].live, size_of(force.type));
        } else {
            std::memcpy(own_[i].live, force.live, size_of(force.type));
            store(force.type, force.live, force.value);
        }
    }
}

void Forces::published(int task) {
    for (std::size_t i = 0; i < forces_.size(); ++i)
        if (own_[i].active && forces_[i].task == task)
            std::memcpy(own_[i].published, own_[i].live, sizeof own_[i].live);
}

std::byte* Forces::own(std::byte* target) {
    for (std::size_t i = 0; i < forces_.size(); ++i)
        if (own_[i].active && forces_[i].live == target) return own_[i].live;
    return target;
}

}  // namespace lineshaft
