# The map on disk. SQLite, libdeflate, OpenSSL and JSON stop here.
find_package(SQLite3 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(nlohmann_json REQUIRED)
find_library(FLOGMAP_DEFLATE deflate REQUIRED)

flogmap_target(map_store
  SOURCES
    map_store.cpp
    store/checksum.cpp
    store/file_lock.cpp
    store/map_digest.cpp
    store/map_file.cpp
    store/map_meta.cpp
    store/map_reader.cpp
    store/map_rows.cpp
    store/map_schema.cpp
    store/map_tables.cpp
    store/sqlite.cpp
    store/store_file.cpp
    store/store_writer.cpp
    store/tile_blob.cpp
  PUBLIC mapping_data flog
  PRIVATE SQLite::SQLite3 OpenSSL::Crypto nlohmann_json::nlohmann_json ${FLOGMAP_DEFLATE} Threads::Threads)
target_compile_definitions(map_store PRIVATE FLOGMAP_VERSION="${PROJECT_VERSION}")

# The same map in the formats of other programs. OpenCV and OctoMap stop here.
find_path(FLOGMAP_OCTOMAP_INCLUDE octomap/OcTree.h REQUIRED)
find_library(FLOGMAP_OCTOMAP octomap REQUIRED)
find_library(FLOGMAP_OCTOMATH octomath REQUIRED)

flogmap_target(map_export
  SOURCES
    export/cell_cloud.cpp
    export/exported_file.cpp
    export/map_export.cpp
    export/map_files.cpp
    export/octomap_map.cpp
    export/path_picture.cpp
    export/picture_file.cpp
    export/png_map.cpp
    export/ros_map.cpp
    export/trajectory_text.cpp
  PUBLIC map_store flog
  PRIVATE flogmap_opencv ${FLOGMAP_OCTOMAP} ${FLOGMAP_OCTOMATH})
target_include_directories(map_export SYSTEM PRIVATE ${FLOGMAP_OCTOMAP_INCLUDE})
