# The map on disk and its exports.
flogmap_test(map_store_tests
  SOURCES
    map_store_disk_test.cpp
    map_store_file_test.cpp
    map_store_kill_test.cpp
    map_store_live_test.cpp
    map_store_support.cpp
    map_store_writer_test.cpp
  LINK map_store)

flogmap_test(mapped_views_tests SOURCES mapped_views_test.cpp LINK mapped_views nlohmann_json::nlohmann_json)

flogmap_test(map_export_tests
  SOURCES
    export_cloud_test.cpp
    export_folder_test.cpp
    export_picture_test.cpp
    map_store_support.cpp
  LINK map_export flogmap_opencv ${FLOGMAP_OCTOMAP} ${FLOGMAP_OCTOMATH})
if(FLOGMAP_TESTS)
  target_include_directories(map_export_tests SYSTEM PRIVATE ${FLOGMAP_OCTOMAP_INCLUDE})
endif()
