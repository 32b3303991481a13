us_test(session_test LABELS fast SOURCES
  tests/session/job_queue_test.cpp
  tests/session/frame_cache_test.cpp
  tests/app/program.cpp
  LIBS understudy_session)
