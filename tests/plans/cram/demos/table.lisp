(in-package :table-plans)

(cpl:def-top-level-cram-function demo-table ()
  (exe:perform (desig:an action (type laying-table))))

(demo-table)
