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
    store/store_writer.cpp
    store/tile_blob.cpp
  PUBLIC mapping_data flog
  PRIVATE SQLite::SQLite3 OpenSSL::Crypto nlohmann_json::nlohmann_json ${FLOGMAP_DEFLATE} Threads::Threads)
target_compile_definitions(map_store PRIVATE FLOGMAP_VERSION="${PROJECT_VERSION}")
