# The map on disk and its exports.
flogmap_test(map_store_tests
  SOURCES
    map_store_file_test.cpp
    map_store_kill_test.cpp
    map_store_live_test.cpp
    map_store_support.cpp
    map_store_writer_test.cpp
  LINK map_store)
