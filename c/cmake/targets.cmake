# nearmiss::nearmiss and nearmiss::static, of the libraries in nearmiss_libraries, the shared one under its nearmiss_soname, and the
# header in nearmiss_include; Threads was found.
if(NOT TARGET nearmiss::nearmiss)
    add_library(nearmiss::nearmiss SHARED IMPORTED GLOBAL)
    set_target_properties(nearmiss::nearmiss PROPERTIES
        IMPORTED_LOCATION "${nearmiss_libraries}/${nearmiss_soname}"
        IMPORTED_SONAME "${nearmiss_soname}"
        INTERFACE_INCLUDE_DIRECTORIES "${nearmiss_include}")
    add_library(nearmiss::static STATIC IMPORTED GLOBAL)
    set_target_properties(nearmiss::static PROPERTIES
        IMPORTED_LOCATION "${nearmiss_libraries}/libnearmiss_c.a"
        INTERFACE_LINK_LIBRARIES "Threads::Threads;${CMAKE_DL_LIBS};m"
        INTERFACE_INCLUDE_DIRECTORIES "${nearmiss_include}")
endif()
