find_package(CLI11 REQUIRED)
flogmap_test(composition_tests
  SOURCES bounded_queue_test.cpp capture_control_test.cpp option_table_test.cpp processor_heat_test.cpp stage_statistics_test.cpp
          pipeline_loop_test.cpp pipeline_recordings_test.cpp pipeline_test.cpp
  LINK pipeline options trajectory CLI11::CLI11)

flogmap_test(continued_map_tests SOURCES continued_map_test.cpp map_store_support.cpp
             LINK continued_map mapped_views pipeline)

flogmap_bench(chain_bench
  SOURCES ${PROJECT_SOURCE_DIR}/tests/bench/chain_bench.cpp
  LINK pipeline nlohmann_json::nlohmann_json)

flogmap_test(live_desk_tests SOURCES live_desk_test.cpp LINK live_desk nlohmann_json::nlohmann_json)
