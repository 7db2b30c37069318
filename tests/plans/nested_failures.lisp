;; Three failure handlers, one inside the other, each with its own answer: look again, clear the
;; way and open again, and at last give the other hand a try.

(in-package :demo-plans)

(defparameter *drawers* '(d-top d-mid d-low))

(def-cram-function look-into (?drawer)
  (exe:perform (desig:a motion (type looking)
                        (target (desig:a location (in (desig:an object (name ?drawer))))))))

(def-cram-function detect (?type)
  (exe:perform (desig:a motion (type detecting) (object (desig:an object (type ?type))))))

(def-cram-function open-drawer (?drawer ?arm)
  (exe:perform (desig:an action (type opening) (arm ?arm)
                         (object (desig:an object (name ?drawer))))))

(def-cram-function close-drawer (?drawer ?arm)
  (exe:perform (desig:an action (type closing) (arm ?arm)
                         (object (desig:an object (name ?drawer))))))

;; What stands open above the drawer is in the way.
(def-cram-function clear-the-way (?drawer ?arm)
  (dolist (?other *drawers*)
    (when (eq ?other ?drawer) (return))
    (when (holds (list 'drawer-open ?other))
      (close-drawer ?other ?arm))))

(def-cram-function take-out-of (?drawer ?type ?arm)
  (let ((?object nil))
    (cpl:with-retry-counters ((looks 1))
      (cpl:with-failure-handling
          ((common-fail:perception-object-not-found (e)
             (roslisp:ros-warn (demo) "~a in ~a: ~a" ?type ?drawer e)
             (cpl:do-retry looks
               (look-into ?drawer)
               (cpl:retry))))
        (setf ?object (detect ?type))))
    (exe:perform (desig:an action (type picking-up) (arm ?arm) (object ?object)))
    ?object))

(def-cram-function search-in (?drawer ?type ?arm)
  (cpl:with-retry-counters ((openings 1))
    (cpl:with-failure-handling
        ((common-fail:manipulation-goal-not-reached (e)
           (cpl:do-retry openings
             (clear-the-way ?drawer ?arm)
             (cpl:retry))
           (cpl:fail 'common-fail:object-unreachable)))
      (open-drawer ?drawer ?arm)
      (look-into ?drawer)
      (take-out-of ?drawer ?type ?arm))))

(defun fetch (?type)
  (let ((?arm 'left))
    (dolist (?drawer '(d-low d-top))
      (cpl:with-retry-counters ((hands 1))
        (cpl:with-failure-handling
            ((common-fail:perception-low-level-failure (e)
               (close-drawer ?drawer ?arm)
               (return))
             ((or common-fail:manipulation-low-level-failure common-fail:high-level-failure) (e)
               (cpl:do-retry hands
                 (setf ?arm 'right)
                 (cpl:retry))
               (cpl:fail 'common-fail:object-unfetchable)))
          (return-from fetch (search-in ?drawer ?type ?arm)))))
    (cpl:fail 'common-fail:object-nowhere-to-be-found)))

(fetch :spoon)
