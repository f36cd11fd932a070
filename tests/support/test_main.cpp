// The main() of test programs: a test may start workers, which are this program again.
#include <gmock/gmock.h>

#include "campaign/workers/worker.hpp"

int main(int argc, char** argv) {
  fleetproof::serve_if_called(argc, argv);
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
