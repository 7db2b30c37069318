(in-package :access-plans)

(defun demo-access ()
  (dolist (?drawer (reverse kit:*drawers*))
    (let ((?location (kit:drawer-location ?drawer)))
      (cpl:with-failure-handling
          ((common-fail:environment-manipulation-impossible (e)
             (roslisp:ros-warn (demo access) "~a stays shut: ~a" ?drawer e)
             (return)))
        (exe:perform (desig:an action (type accessing) (location ?location))))))
  ;; what is open already is left as it is
  (exe:perform (desig:an action
                         (type accessing)
                         (object (desig:an object (name d-low)))
                         (arms (right left)))))

(demo-access)
