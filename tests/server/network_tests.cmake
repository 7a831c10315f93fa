# The network side: laws of board and outbox, the wire, and a real hub on a loopback port.
find_package(nlohmann_json REQUIRED)
find_package(OpenSSL REQUIRED)
flogmap_target(synthetic_walk SOURCES synthetic_walk.cpp PUBLIC mapping_data)

# Not a test: a map that grows by itself, to look at and to develop the page against.
flogmap_target(hub_demo EXECUTABLE SOURCES hub_demo.cpp PRIVATE hub synthetic_walk)

flogmap_target(wire_samples SOURCES wire_samples.cpp PUBLIC board PRIVATE proto)
flogmap_target(make_wire_samples EXECUTABLE SOURCES make_wire_samples.cpp PRIVATE wire_samples)
flogmap_test(wire_tests SOURCES wire_golden_test.cpp LINK wire_samples board proto nlohmann_json::nlohmann_json)

flogmap_target(tile_mirror SOURCES tile_mirror.cpp PUBLIC board PRIVATE proto)
flogmap_test(outbox_tests SOURCES outbox_law_test.cpp send_window_test.cpp LINK tile_mirror board proto)

flogmap_target(loopback_hub SOURCES loopback_hub.cpp PUBLIC hub PRIVATE network_libraries)
flogmap_target(bad_network SOURCES cutting_proxy.cpp raw_stream.cpp test_certificate.cpp
               PRIVATE network_libraries OpenSSL::Crypto)
flogmap_test(hub_tests SOURCES hub_access_test.cpp hub_batch_test.cpp hub_http_test.cpp hub_stream_test.cpp openapi_test.cpp
             LINK loopback_hub client_frames synthetic_walk tile_mirror hub proto nlohmann_json::nlohmann_json)
flogmap_test(hub_attack_tests SOURCES hub_attack_test.cpp hub_frame_attack_test.cpp hub_proxy_test.cpp hub_tls_test.cpp
             LINK bad_network loopback_hub client_frames synthetic_walk tile_mirror hub network_libraries
                  nlohmann_json::nlohmann_json)

# The program itself, as a process of its own.
find_package(yaml-cpp REQUIRED)
flogmap_test(program_tests SOURCES contract_cases.cpp contract_test.cpp json_schema.cpp map_store_support.cpp
                                   program_commands_test.cpp program_disk_test.cpp
                                   program_recording_test.cpp program_store_test.cpp
                                   running_program.cpp
             LINK camera client_frames loopback_hub map_store nlohmann_json::nlohmann_json yaml-cpp)
if(FLOGMAP_TESTS)
  target_compile_definitions(program_tests PRIVATE FLOGMAP_PROGRAM="$<TARGET_FILE:flogmap>")
  add_dependencies(program_tests flogmap)
endif()

flogmap_target(client_frames SOURCES client_frames.cpp PUBLIC wire PRIVATE proto)
flogmap_test(log_tests SOURCES log_test.cpp LINK log nlohmann_json::nlohmann_json)
flogmap_test(board_tests SOURCES tile_board_test.cpp LINK board api)
flogmap_test(stream_tests SOURCES stream_protocol_test.cpp access_test.cpp http_values_test.cpp
             LINK client_frames synthetic_walk tile_mirror hub api nlohmann_json::nlohmann_json)

flogmap_bench(serve_bench
  SOURCES ${PROJECT_SOURCE_DIR}/tests/bench/serve_bench.cpp ${PROJECT_SOURCE_DIR}/tests/bench/serve_fetch.cpp
          ${PROJECT_SOURCE_DIR}/tests/bench/serve_load.cpp ${PROJECT_SOURCE_DIR}/tests/bench/serve_snapshot.cpp
          running_program.cpp
  LINK bad_network loopback_hub client_frames synthetic_walk hub network_libraries proto nlohmann_json::nlohmann_json)
if(FLOGMAP_BENCH)
  target_compile_definitions(serve_bench PRIVATE FLOGMAP_PROGRAM="$<TARGET_FILE:flogmap>"
                                                 FLOGMAP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  add_dependencies(serve_bench flogmap)
endif()
