#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/serve/http.hpp"
#include "runtime/serve/modbus_session.hpp"

namespace lineshaft::test {

/// A small program that is served in this thread, without a port. It is paused: its time moves by
/// steps only.
class ServedMachine {
  public:
    ServedMachine();

    /// All that a client could change.
    std::string state() const;

    /// One scan further, without forces: what was written counts now, and nothing piles up.
    void go_on();

    /// Values of the program's inputs.
    std::string inputs() const;

    /// `inputs.fixed`, which may be forced, but not set by Modbus, is what it was.
    bool is_fixed() const;

    /// Answers the bytes of a client that then sends no more, by what answers it.
    static std::string answer(std::string_view bytes, const std::function<void(Client&)>& converse);

    /// The only one. A new one when the time of the last one has ended.
    static ServedMachine& get();

  private:
    std::atomic<bool> interrupt_ = false;
    Loaded loaded_;
    Executive executive_;

  public:
    Live live;
    Desk desk;
    Api api;
    HttpOptions options{
        .address = {}, .guard = {.most_requests = never}, .page = "<!doctype html>"};
    HttpServer http{api, options, World::system()};
    const ModbusMap& map;
};

}  // namespace lineshaft::test
