#include "hal/can/bus.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "hal/can/gateway.hpp"
#include "hal/can/robot_ecus.hpp"
#include "tests/hal/can/link_both.hpp"

using namespace can_test;

TEST_CASE("two participants of a UDP bus receive each other's frames, in order and complete") {
  receives_in_order(free_udp_bus());
}

TEST_CASE("own frames are not received on a UDP bus") {
  does_not_receive_own_frames(free_udp_bus());
}

TEST_CASE("all participants of a UDP bus receive the same frames") {
  all_participants_receive(free_udp_bus());
}

TEST_CASE("frames beyond the size of the receive buffer are returned by the next call") {
  keeps_remaining_frames(free_udp_bus());
}

TEST_CASE("gateway and ECUs run in lockstep over UDP") { runs_in_lockstep(free_udp_bus()); }

TEST_CASE("datagrams of another format are counted and dropped") {
  const auto specification = free_udp_bus();
  const auto bus = erp::open_bus(specification);
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(std::uint16_t(std::stoi(specification.substr(specification.rfind(':') + 1))));
  ::inet_pton(AF_INET, "239.255.42.1", &to.sin_addr);
  const in_addr loopback{htonl(INADDR_LOOPBACK)};
  ::setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  for (std::string text :
       {"", "erpc", "erpc1234567890", "erpd12345678901", "some other program's words"}) {
    const auto sent =
        ::sendto(fd, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
    REQUIRE(sent == ssize_t(text.size()));
  }
  ::close(fd);
  erp::CanFrame frame;
  while (bus->counters().unreadable < 5) CHECK(bus->receive({&frame, 1}, 10) == 0);
  CHECK(bus->counters().received == 0);
}

TEST_CASE("the error of a bus that cannot be opened gives specification, reason and remedy") {
  const std::pair<const char*, const char*> cases[] = {
      {"", "unknown back end"},
      {"ethercat:0", "unknown back end \"ethercat\"; write socketcan:INTERFACE"},
      {"udp", "names no group and port"},
      {"udp:239.255.42.1", "names no group and port"},
      {"udp:239.255.42.1:", "port \"\" is not a number from 1 to 65535"},
      {"udp:239.255.42.1:0", "port \"0\""},
      {"udp:239.255.42.1:65536", "port \"65536\""},
      {"udp:239.255.42.1:20x", "port \"20x\""},
      {"udp:127.0.0.1:20000", "\"127.0.0.1\" is not a multicast address; write one from 239.0.0.0"},
      {"udp:here:20000", "\"here\" is not a multicast address"},
      {"socketcan", "names no interface"},
      {"socketcan:", "names no interface"},
  };
  for (const auto& [specification, remedy] : cases) {
    INFO(specification);
    CHECK_THROWS_WITH(erp::open_bus(specification),
                      Catch::Contains(std::string("CAN bus \"") + specification + "\"") &&
                          Catch::Contains(remedy));
  }
}

TEST_CASE("the error of a missing CAN interface gives the commands to list or create one") {
  // A kernel without CAN reports that; one with CAN names the interface.
  CHECK_THROWS_WITH(
      erp::open_bus("socketcan:nowhere0"),
      Catch::Contains("this kernel has no SocketCAN; use udp:239.255.42.1:20000") ||
          Catch::Contains("no interface \"nowhere0\"; `ip -br link show type can` lists them"));
}

TEST_CASE("each ERP_DOMAIN has its own ports, one for each possible bus of a robot") {
  const char* before = std::getenv("ERP_DOMAIN");
  const std::string domain = before ? before : "0";
  setenv("ERP_DOMAIN", "0", 1);
  CHECK(erp::default_bus() == "udp:239.255.42.1:20000");
  setenv("ERP_DOMAIN", "3", 1);
  CHECK(erp::default_bus() == "udp:239.255.42.1:20048");
  setenv("ERP_DOMAIN", domain.c_str(), 1);
}
