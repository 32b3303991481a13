us_test(session_test LABELS fast SOURCES
  tests/session/job_queue_test.cpp
  tests/session/frame_cache_test.cpp tests/session/studio_test.cpp
  tests/session/studio_character_test.cpp tests/retarget/character/characters.cpp
  tests/session/document_test.cpp
  tests/session/document_file_test.cpp
  tests/session/autosave_test.cpp
  tests/session/settings_test.cpp
  tests/session/full_document.cpp
  tests/app/program.cpp
  LIBS understudy_session)
