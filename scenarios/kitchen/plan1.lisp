;; Set the table: milk, cereal and bowl from the counter, the spoon from a drawer, one after the
;; other to the cells of the table.

(in-package :kitchen-demo)

(defparameter *work-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.72 0.06 0) (make-identity-rotation)))
(defparameter *table-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.10 0.56 0) (make-quaternion 0 0 1 0)))

(defparameter *counter-cells*
  (list (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.075 0.85) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.225 0.85) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.375 0.85) (make-identity-rotation))))

(defparameter *milk-spot*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.475 0.86) (make-identity-rotation)))
(defparameter *cereal-spot*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.625 0.86) (make-identity-rotation)))
(defparameter *bowl-spot*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.775 0.86) (make-identity-rotation)))
(defparameter *spoon-spot*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.925 0.86) (make-identity-rotation)))

(def-cram-function drive-to (?pose)
  (exe:perform (desig:a motion (type going) (target (desig:a location (pose ?pose))))))

(def-cram-function park (?arm)
  (exe:perform (desig:an action (type parking-arms) (arm ?arm))))

(def-cram-function pick-up (?object)
  (exe:perform (desig:an action (type picking-up) (arm left) (object ?object))))

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

;; Drawers are closed again, also the one that the spoon was in; the hand that holds the spoon pushes.
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
        (exe:perform (desig:an action (type closing) (arm left)
                               (object (desig:an object (name ?drawer)))))
        (return-from fetch-from-drawers ?found)))
    (exe:perform (desig:an action (type closing) (arm left)
                           (object (desig:an object (name ?drawer))))))
  (cpl:fail 'common-fail:object-nowhere-to-be-found))

(def-cram-function deliver (?object ?spot)
  (drive-to *table-pose*)
  (exe:perform (desig:an action (type placing) (arm left) (object ?object)
                         (target (desig:a location (pose ?spot)))))
  (park :left))

(def-cram-function bring-from-counter (?type ?spot)
  (let ((?object (find-on-counter ?type)))
    (pick-up ?object)
    (park :left)
    (deliver ?object ?spot)
    (drive-to *work-pose*)))

(def-cram-function set-the-table ()
  (bring-from-counter :milk *milk-spot*)
  (bring-from-counter :breakfast-cereal *cereal-spot*)
  (bring-from-counter :bowl *bowl-spot*)
  (let ((?spoon (fetch-from-drawers :spoon)))
    (park :left)
    (park :right)
    (deliver ?spoon *spoon-spot*)))

(set-the-table)
