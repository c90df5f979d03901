# `cpack` in the build folder, or `make deb`: cloud2csg_VERSION_ARCH.deb with the program, libcloud2csg-dev_... with the
# library. STEP and BREP need OpenCASCADE, whose many libraries are recommended, not required.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cloud2csg)
set(CPACK_PACKAGE_VENDOR cloud2csg)
set(CPACK_PACKAGE_CONTACT "The cloud2csg developers <cloud2csg@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "from a noisy point cloud to an editable CSG tree")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL Program Development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME cloud2csg)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "Turns a scan, a point cloud or a mesh into one formula of unions, intersections and differences over boxes, spheres, \
cylinders, cones and tori that opens in OpenSCAD and CAD programs.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "openscad, gnuplot-nox, xdg-utils")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libcloud2csg-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "The library of cloud2csg, its headers, and packages for CMake and pkg-config.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev, libtbb-dev, libhwy-dev, libboost-dev, libccd-dev, libmuparser-dev, libzip-dev, libpugixml-dev, libceres-dev, \
libembree-dev, nlohmann-json3-dev, libfmt-dev, zlib1g-dev, libpng-dev, libmeshoptimizer-dev, pkg-config")
# The module with OpenCASCADE is in the program's package.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cloud2csg (= ${PROJECT_VERSION})")

# What the program and its module link, by dpkg-shlibdeps; CPack's own use of it knows no recommendations.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/deb_dependencies.cmake)
set(CPACK_CLOUD2CSG_PROGRAM usr/${CMAKE_INSTALL_BINDIR}/cloud2csg)
if(TARGET cloud2csg_opencascade)
  set(CPACK_CLOUD2CSG_MODULE usr/${CLOUD2CSG_INSTALL_MODULEDIR}/libcloud2csg_opencascade.so)
endif()

install(
  FILES ${PROJECT_SOURCE_DIR}/LICENSE
  DESTINATION ${CMAKE_INSTALL_DOCDIR}
  RENAME copyright
  COMPONENT Program)
install(
  FILES ${PROJECT_SOURCE_DIR}/LICENSE
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libcloud2csg-dev
  RENAME copyright
  COMPONENT Development)
include(CPack)
