us_test(pipeline_test LABELS fast SOURCES
  tests/retarget/pipeline/copy_transfer_test.cpp
  tests/retarget/pipeline/joint_filter_test.cpp
  tests/retarget/pipeline/person_check_test.cpp
  tests/retarget/pipeline/root_path_test.cpp
  tests/retarget/pipeline/retargeter_test.cpp
  LIBS understudy_pipeline)
us_test(foot_lock_test LABELS fast SOURCES tests/retarget/pipeline/foot_lock_test.cpp
  LIBS understudy_pipeline understudy_builtin understudy_metrics)
us_test(hand_contacts_test LABELS fast SOURCES
  tests/retarget/pipeline/hand_contacts_test.cpp tests/retarget/metrics/hand_contact_test.cpp
  LIBS understudy_pipeline understudy_builtin understudy_body understudy_metrics)
us_test(long_run_test LABELS fast SOURCES tests/retarget/pipeline/long_run_test.cpp
  LIBS understudy_pipeline understudy_builtin understudy_metrics)
