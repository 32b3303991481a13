# cmake --install, and the Debian package (the target package). The program finds its files relative to itself.
install(TARGETS understudy RUNTIME DESTINATION bin)
install(TARGETS networks_plugin LIBRARY DESTINATION lib/understudy)
install(DIRECTORY assets/weights DESTINATION share/understudy FILES_MATCHING PATTERN *.weights PATTERN README.md)
install(DIRECTORY assets/samples assets/styles assets/study_web assets/batch DESTINATION share/understudy USE_SOURCE_PERMISSIONS)
install(FILES cmake/install/understudy.desktop DESTINATION share/applications)
install(FILES cmake/install/understudy.svg DESTINATION share/icons/hicolor/scalable/apps)
install(FILES cmake/install/understudy.xml DESTINATION share/mime/packages)
install(FILES LICENSE DESTINATION share/doc/understudy RENAME copyright)

# The man page is what the program's own help says.
set(man_page ${PROJECT_BINARY_DIR}/understudy.1.gz)
add_custom_command(OUTPUT ${man_page} DEPENDS understudy ${PROJECT_SOURCE_DIR}/cmake/install/man_page.sh
  COMMAND ${PROJECT_SOURCE_DIR}/cmake/install/man_page.sh $<TARGET_FILE:understudy> ${man_page})
add_custom_target(man_page ALL DEPENDS ${man_page})
install(FILES ${man_page} DESTINATION share/man/man1)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME understudy)
set(CPACK_PACKAGE_CONTACT "The Understudy authors <understudy@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "lets any body perform any captured motion")
set(CPACK_PACKAGE_DESCRIPTION "A studio that opens raw 4D scans or motions, lets a character perform them frame by
frame, shows every stage, takes corrections and exports animated glTF and other formats.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What no linker sees: EGL and OpenGL are loaded at run time, and LibTorch takes whichever BLAS there is.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "fonts-inter, libegl1, libgl1-mesa-dri, libopenblas0-openmp")
include(CPack)
