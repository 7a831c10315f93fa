flogmap_test(composition_tests
  SOURCES server/bounded_queue_test.cpp server/capture_control_test.cpp server/option_table_test.cpp
          server/stage_statistics_test.cpp server/pipeline_test.cpp
  LINK pipeline options)
