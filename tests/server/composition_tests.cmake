find_package(CLI11 REQUIRED)
flogmap_test(composition_tests
  SOURCES bounded_queue_test.cpp capture_control_test.cpp option_table_test.cpp stage_statistics_test.cpp
          pipeline_test.cpp
  LINK pipeline options CLI11::CLI11)
