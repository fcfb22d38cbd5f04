#include "runtime/serve/connection.hpp"

#include <array>
#include <atomic>
#include <optional>
#include <string>

#include <catch2/catch.hpp>
#include <sys/socket.h>
#include <unistd.h>

using namespace lineshaft;

namespace {

/// Two ends of a connection, of which one is a client's.
struct Ends {
    Ends() {
        std::array<int, 2> ends{};
        REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
        other = ends[0];
        client.emplace(system_socket(ends[1]), 0);
        connection.emplace(*client, World::system());
    }
    ~Ends() { ::close(other); }

    int other = -1;
    std::optional<Client> client;
    std::optional<Connection> connection;
};

}  // namespace

TEST_CASE("a client that takes no answers is asked for nothing more, whatever it has sent") {
    Ends ends;
    Connection& connection = *ends.connection;
    REQUIRE(::send(ends.other, "one two three", 13, 0) == 13);
    REQUIRE(connection.begin());
    std::array<char, 3> got{};
    CHECK(connection.read(got.data(), got.size()) == 3);
    CHECK(connection.write("answer", 6) == 6);
    ::shutdown(ends.other, SHUT_RD);
    CHECK(connection.write("answer", 6) == -1);
    CHECK(connection.write("answer", 6) == -1);
    CHECK(connection.read(got.data(), got.size()) == -1);
    CHECK_FALSE(connection.begin());
}

TEST_CASE("a client that sends too much is still answered") {
    Ends ends;
    Connection& connection = *ends.connection;
    const std::string head(20'000, 'x');
    REQUIRE(::send(ends.other, head.data(), head.size(), 0) == 20'000);
    REQUIRE(connection.begin());
    std::array<char, 1000> got{};
    while (connection.read(got.data(), got.size()) > 0) continue;
    CHECK_FALSE(connection.begin());
    CHECK(connection.write("refused", 7) == 7);
    CHECK(::recv(ends.other, got.data(), got.size(), 0) == 7);
}

TEST_CASE("a client whose request has come and was not read yet does not give way to others") {
    std::atomic<bool> ends = false;
    std::array<std::array<int, 2>, 3> lines{};
    for (auto& line : lines) REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, line.data()) == 0);
    constexpr std::size_t asks = 0, idle = 1, comes = 2;
    REQUIRE(::send(lines[asks][0], "GET", 3, 0) == 3);
    World& world = World::system();
    {
        Clients clients(world, 2, [&](Client&) {
            while (!ends) world.sleep_until(world.now() + 1'000'000);  // busy elsewhere
        });
        for (auto& line : lines) clients.admit(system_socket(line[1]));
        char byte = 0;
        CHECK(::recv(lines[idle][0], &byte, 1, MSG_DONTWAIT) == 0);
        for (const std::size_t stays : {asks, comes})
            CHECK(::recv(lines[stays][0], &byte, 1, MSG_DONTWAIT) == -1);
        ends = true;
    }
    for (auto& line : lines) ::close(line[0]);
}
