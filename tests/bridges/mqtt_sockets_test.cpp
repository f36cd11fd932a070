// mosquitto's clients and broker and ours over loopback sockets, where they are installed. The recordings hold for the
// rest, and for machines without them.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::mqtt_sockets_test {
namespace {

class MqttSockets : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    if (shell("command -v mosquitto mosquitto_pub mosquitto_sub").exit_code != 0)
      GTEST_SKIP() << "mosquitto and mosquitto-clients are not installed";
  }
  // Lines for bash. `sub` and `pub` are mosquitto's clients, before our broker.
  test::Finished with_our_broker(const std::string& lines) const {
    return shell(std::string("mkfifo input\n'") + FLEETPROOF_MQTT_DIALOGUE + R"sh(' serve recording <input >port &
exec 8>input
until [ -s port ]; do sleep 0.02; done
pub() { mosquitto_pub -p $(cat port) "$@" 8>&-; }
sub() { timeout 30 mosquitto_sub -p $(cat port) "$@" 8>&-; }
)sh" + lines + "\nexec 8>&-\nwait\n");
  }
};

TEST_F(MqttSockets, MosquittosClientsAreServedByOurBroker) {
  const auto finished = with_our_broker(R"sh(
sub -i agv -c -t order -q 1 -E
pub -i master -t order -m o1 -q 1
pub -i master -t order -m o2 -q 1
pub -i master -t order -m lost
sub -i agv -c -t order -q 1 -C 2
pub -i agv2 -t c/agv2 -m ONLINE -q 1 -r
sub -i watch -t 'c/+' -q 1 -C 1 -F '%t %r %q %p'
)sh");
  EXPECT_EQ(finished.out, "o1\no2\nc/agv2 1 1 ONLINE\n") << finished.err;
}

TEST_F(MqttSockets, WhatOurBrokerDoesNotOfferIsSaidByMosquittosClients) {
  const auto finished = with_our_broker(R"sh(
pub -i a -V mqttv5 -t t -m x 2>&1 | head -1 | cut -d. -f1
pub -i a -u u -P p -t t -m x 2>&1 | head -1
pub -i a -q 2 -t t -m x 2>&1 | head -1
)sh");
  EXPECT_EQ(finished.out,
            "Connection error: Unsupported Protocol Version\n"
            "Connection error: Connection Refused: not authorised.\n"
            "Error: The connection was lost.\n")
      << finished.err;
  EXPECT_THAT(read(path("recording")), testing::HasSubstr("publishes with QoS 2, which is not offered"));
}

TEST_F(MqttSockets, OurClientIsServedByMosquitto) {
  // mosquitto takes no port of the system's choice: a few are tried.
  const auto finished = shell(std::string(R"sh(
for port in $(shuf -i 20000-30000 -n 20); do
  printf 'listener %s 127.0.0.1\nallow_anonymous true\n' $port >conf
  mosquitto -c conf >log 2>&1 &
  broker=$!
  until grep -q -e running -e Error log; do sleep 0.02; done
  grep -q running log && break
done
mkfifo input
')sh") + FLEETPROOF_MQTT_DIALOGUE +
                              R"sh(' client recording $port <input >heard &
exec 8>input
sub() { timeout 30 mosquitto_sub -p $port "$@" 8>&-; }
sub -i watch -c -t state -q 1 -E
until grep -q "^hear.*9004" recording; do sleep 0.02; done
echo "publish 1 0 state s1" >&8
sub -i watch -c -t state -q 1 -C 1
mosquitto_pub -p $port -i master -t order/1 -m o1 -q 1 8>&-
until [ -s heard ]; do sleep 0.02; done
exec 8>&-
sub -i master -t c/agv -C 1
cat heard
kill $broker
wait
)sh");
  EXPECT_EQ(finished.out, "s1\nCONNECTIONBROKEN\norder/1 o1\n") << finished.err << read(path("recording"));
}

}  // namespace
}  // namespace fleetproof::mqtt_sockets_test
