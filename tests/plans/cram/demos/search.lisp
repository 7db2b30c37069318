(in-package :search-plans)

(cpl:def-cram-function demo-search (&optional (type :spoon))
  (let* ((?type type)
         (?spoon (desig:an object (type ?type))))
    (multiple-value-bind (found where)
        (exe:perform (desig:an action (type searching) (object ?spoon)))
      (roslisp:ros-info (demo search) "~a is in ~a" found where)
      found)
    (exe:perform (desig:an action (type picking-up) (arm left) (object ?spoon)))))

(demo-search)
