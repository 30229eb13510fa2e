# What an installed Lumorph consists of, and the Debian package made of it (packaging/deb).
include(GNUInstallDirs)

install(TARGETS lumorph RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# devices/transport/link_failsafe.cpp looks for it beside the program.
install(TARGETS lumorph-servo-failsafe RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET lumorph_mpi)
    # core/search/shared_batch.cpp looks for ../lib/lumorph beside the program.
    install(TARGETS lumorph_mpi LIBRARY DESTINATION lib/lumorph)
endif()
# core/base/resources.cpp looks for ../share/lumorph beside the program.
install(DIRECTORY resources/examples resources/fonts resources/guide resources/icons resources/levels resources/materials resources/models resources/projects
                  resources/shaders resources/targets resources/thumbnails
        DESTINATION ${CMAKE_INSTALL_DATADIR}/lumorph
        PATTERN generator EXCLUDE PATTERN CMakeLists.txt EXCLUDE)
# devices/firmware/sketch.cpp takes it from there.
install(DIRECTORY devices/firmware/tablet DESTINATION ${CMAKE_INSTALL_DATADIR}/lumorph/firmware)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Under the name that README.md links to; the studio shows it from where its other resources are.
file(CREATE_LINK ../../../lumorph/guide ${CMAKE_BINARY_DIR}/guide SYMBOLIC)
install(FILES ${CMAKE_BINARY_DIR}/guide DESTINATION ${CMAKE_INSTALL_DOCDIR}/resources)
install(FILES packaging/desktop/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Who may open servo controllers. udev looks in /usr/lib and /usr/local/lib, not in the folders of an architecture.
install(FILES packaging/udev/60-lumorph.rules DESTINATION lib/udev/rules.d)

if(TARGET lumorph-studio)
    install(TARGETS lumorph-table RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    install(TARGETS lumorph-studio RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    install(FILES packaging/desktop/io.lumorph.Studio.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
    install(FILES packaging/desktop/io.lumorph.Studio.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo)
    install(FILES packaging/desktop/lumorph.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
    install(FILES resources/icons/lumorph.svg
            DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
    install(FILES resources/icons/application-x-lumorph.svg
            DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/mimetypes)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_NAME lumorph)
set(CPACK_PACKAGE_VENDOR "Lumorph")
set(CPACK_PACKAGE_CONTACT "The Lumorph developers <developers@lumorph.io>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
# Libraries are found by what the programs link; these are loaded at run time.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri | libgl1-nvidia-glvnd-glx, qt6-qpa-plugins, shared-mime-info, hicolor-icon-theme")
# What starts a search on several machines at once.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "openmpi-bin")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
