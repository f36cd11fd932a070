# The tests that continuous integration runs under sanitizers: chosen where a wrong access or a race is likely, and few
# enough to build and run in minutes. Everything else is label `soak` in these builds.
file(GLOB engine_tests CONFIGURE_DEPENDS core/*_test.cpp)
# The detector's geometry and the statistics of the radio own no memory and cost minutes here.
list(FILTER engine_tests EXCLUDE REGEX "detector|clearance|geometry|piece|curve|motion_profile|swept_region|\
radio_(air_time|crossing|interference|loss|outage)")
if(FLEETPROOF_SANITIZE MATCHES thread)
  set(sanitized_sources campaign/task_pool_test.cpp campaign/trials_test.cpp campaign/findings_test.cpp
    campaign/failure_needs_test.cpp campaign/workers_test.cpp campaign/audit_finding_test.cpp
    storage/archive_test.cpp)
  set(planted planted_race)
  set(report "ThreadSanitizer: data race")
else()
  set(sanitized_sources ${engine_tests} fuzz/readers_test.cpp fuzz/readers.cpp fuzz/seeds.cpp fuzz/verdict.cpp
    campaign/task_pool_test.cpp campaign/trials_test.cpp campaign/workers_test.cpp campaign/channel_test.cpp
    campaign/forker_test.cpp campaign/findings_test.cpp campaign/delivery_passes_test.cpp
    campaign/untidy_software_test.cpp campaign/audit_finding_test.cpp campaign/system_calls_test.cpp
    storage/archive_test.cpp)
  set(planted planted_use_after_free)
  set(report "AddressSanitizer: heap-use-after-free")
endif()
# One variable: gtest_discover_tests takes a list of them apart.
if(FLEETPROOF_SANITIZE MATCHES thread)
  set(sanitizer_options "TSAN_OPTIONS=suppressions=${CMAKE_CURRENT_SOURCE_DIR}/tsan.supp")
else()
  set(sanitizer_options "ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1")
endif()

add_executable(sanitized_tests EXCLUDE_FROM_ALL ${sanitized_sources})
target_link_libraries(sanitized_tests
  PRIVATE fleetproof_campaign fleetproof_evidence exact_binomial rapidcheck test_main
    nlohmann_json::nlohmann_json fmt::fmt SQLiteCpp SQLite::SQLite3 TBB::tbb boost_context)
target_compile_definitions(sanitized_tests PRIVATE FLEETPROOF_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
  FLEETPROOF_PLUGIN="$<TARGET_FILE:fleetproof_agents_plugin>"
  FLEETPROOF_RETOUCHED_AGENT="$<TARGET_FILE:retouched_agent>" FLEETPROOF_UNTIDY_AGENT="$<TARGET_FILE:untidy_agent>"
  FLEETPROOF_ECHO_WORKER="$<TARGET_FILE:echo_worker>")
add_dependencies(sanitized_tests fleetproof_agents_plugin retouched_agent untidy_agent echo_worker)
target_compile_options(sanitized_tests PRIVATE ${test_warnings})
target_precompile_headers(sanitized_tests
  PRIVATE <gtest/gtest.h> <gmock/gmock.h> <Eigen/Core> <fmt/format.h> <map> <set> <string> <vector>)
batch(sanitized_tests)
gtest_discover_tests(sanitized_tests TEST_PREFIX Sanitized. DISCOVERY_TIMEOUT 600
  PROPERTIES LABELS sanitized TIMEOUT ${hang_s} ENVIRONMENT "${sanitizer_options}")

# A fault planted for the sanitizer. The test passes only if the sanitizer reports it.
add_executable(${planted} EXCLUDE_FROM_ALL contract/${planted}.cpp)
target_link_libraries(${planted} PRIVATE fleetproof_campaign)
add_test(NAME Sanitizer.Finds_${planted} COMMAND ${planted})
set_tests_properties(Sanitizer.Finds_${planted} PROPERTIES LABELS sanitized TIMEOUT ${hang_s}
  ENVIRONMENT "${sanitizer_options}" PASS_REGULAR_EXPRESSION "${report}")

add_custom_target(sanitized DEPENDS sanitized_tests ${planted})
