;; Bowl and spoon to the table, the spoon first. Every drawer is closed again, also the one that the
;; spoon was in (by the right hand, as the left one holds the spoon); what was picked up is gripped a
;; second time with more force, and the robot drives slowly.

(in-package :kitchen-demo)

(defparameter *work-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.72 0.06 0) (make-identity-rotation)))
(defparameter *table-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.10 0.56 0) (make-quaternion 0 0 1 0)))

(defparameter *counter-cells*
  (list (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.075 0.85) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.225 0.85) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.375 0.85) (make-identity-rotation))))

(defparameter *bowl-spot*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.625 0.86) (make-identity-rotation)))
(defparameter *spoon-spot*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.775 0.86) (make-identity-rotation)))

(def-cram-function drive-to (?pose)
  (exe:perform (desig:a motion (type going) (target (desig:a location (pose ?pose)))
                        (speed 0.25))))

(def-cram-function park-arms ()
  (exe:perform (desig:an action (type parking-arms) (arm left)))
  (exe:perform (desig:an action (type parking-arms) (arm right))))

(def-cram-function pick-up (?object)
  (exe:perform (desig:an action (type picking-up) (arm left) (object ?object)))
  (exe:perform (desig:an action (type regripping) (arm left) (grasping-force 40))))

(defun find-on-counter (?type)
  (dolist (?cell *counter-cells*)
    (exe:perform (desig:a motion (type looking) (target (desig:a location (pose ?cell)))))
    (cpl:with-failure-handling
        ((common-fail:perception-low-level-failure (e)
           (roslisp:ros-info (demo) "no ~a here: ~a" ?type e)
           (return)))
      (return-from find-on-counter
        (exe:perform (desig:a motion (type detecting) (object (desig:an object (type ?type))))))))
  (cpl:fail 'common-fail:object-nowhere-to-be-found))

(def-cram-function close-drawer (?drawer)
  (exe:perform (desig:an action (type closing) (arm left)
                         (object (desig:an object (name ?drawer))))))

(defun fetch-from-drawers (?type)
  (dolist (?drawer '(:d-top :d-mid :d-low))
    (exe:perform (desig:an action (type opening) (arm left)
                           (object (desig:an object (name ?drawer)))))
    (exe:perform (desig:a motion (type looking)
                          (target (desig:a location (in (desig:an object (name ?drawer)))))))
    (let ((?found nil))
      (cpl:with-failure-handling
          ((common-fail:perception-low-level-failure (e) (return)))
        (setf ?found
              (exe:perform (desig:a motion (type detecting)
                                    (object (desig:an object (type ?type)))))))
      (when ?found
        (pick-up ?found)
        (close-drawer ?drawer)
        (return-from fetch-from-drawers ?found)))
    (close-drawer ?drawer))
  (cpl:fail 'common-fail:object-nowhere-to-be-found))

(def-cram-function deliver (?object ?spot)
  (park-arms)
  (drive-to *table-pose*)
  (exe:perform (desig:an action (type placing) (arm left) (object ?object)
                         (target (desig:a location (pose ?spot)))))
  (park-arms))

(def-cram-function bring-bowl-and-spoon ()
  (deliver (fetch-from-drawers :spoon) *spoon-spot*)
  (drive-to *work-pose*)
  (let ((?bowl (find-on-counter :bowl)))
    (pick-up ?bowl)
    (deliver ?bowl *bowl-spot*)))

(bring-bowl-and-spoon)
