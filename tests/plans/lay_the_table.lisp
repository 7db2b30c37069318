;; Lay the table for breakfast and clear what is in the way: bowl, cereal and milk from the counter,
;; a spoon from a drawer that may be hard to open. Both hands carry. What cannot be had is left out,
;; and the robot ends with parked arms and closed drawers whatever happens.

(in-package :demo-plans)

;;; Where things are, and where they belong.

(defparameter *work-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.72 0.06 0) (make-identity-rotation)))
(defparameter *table-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.10 0.58 0) (make-quaternion 0 0 1 0)))

(defparameter *left-cell*
  (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.375 0.85) (make-identity-rotation)))
(defparameter *middle-cell*
  (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.225 0.85) (make-identity-rotation)))
(defparameter *right-cell*
  (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.075 0.85) (make-identity-rotation)))
(defparameter *cells* (list *right-cell* *middle-cell* *left-cell*))

(defparameter *spots*
  (list (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.475 0.86) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.625 0.86) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.775 0.86) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 0.925 0.86) (make-identity-rotation))))

(defparameter *drawers* '(d-top d-mid d-low))

(define-condition item-left-out (high-level-failure) ((reason :initarg :reason)))

;;; Small steps.

(def-cram-function park (?arm)
  (unless (holds (list 'parked ?arm))
    (exe:perform (desig:an action (type parking-arms) (arm ?arm)))))

(def-cram-function park-arms ()
  (park :left)
  (park :right))

(def-cram-function drive-to (?pose)
  (cpl:with-retry-counters ((drives 1))
    (cpl:with-failure-handling
        ((common-fail:navigation-low-level-failure (e)
           (roslisp:ros-warn (demo) "could not drive: ~a" e)
           (cpl:do-retry drives
             (park-arms)
             (cpl:retry))))
      (exe:perform (desig:a motion (type going) (target (desig:a location (pose ?pose))))))))

(def-cram-function look-at (?where)
  (exe:perform (desig:a motion (type looking) (target ?where))))

(def-cram-function detect (?type)
  (exe:perform (desig:a motion (type detecting) (object (desig:an object (type ?type))))))

(def-cram-function grasp (?object ?arm)
  (exe:perform (desig:an action (type picking-up) (arm ?arm) (object ?object))))

(def-cram-function put-down (?object ?arm ?spot)
  (exe:perform (desig:an action (type placing) (arm ?arm) (object ?object)
                         (target (desig:a location (pose ?spot))))))

(def-cram-function move-drawer (?how ?drawer ?arm)
  (if (eq ?how :open)
      (exe:perform (desig:an action (type opening) (arm ?arm)
                             (object (desig:an object (name ?drawer)))))
      (exe:perform (desig:an action (type closing) (arm ?arm)
                             (object (desig:an object (name ?drawer)))))))

;;; Finding.

(defun find-on-counter (?type)
  (dolist (?cell *cells*)
    (look-at (desig:a location (pose ?cell)))
    (cpl:with-failure-handling
        ((common-fail:perception-low-level-failure (e)
           (roslisp:ros-info (demo) "no ~a in this cell" ?type)
           (return)))
      (return-from find-on-counter (detect ?type))))
  (cpl:fail 'item-left-out :reason "not on the counter"))

(def-cram-function close-all-drawers (?arm)
  (dolist (?drawer *drawers*)
    (when (holds (list 'drawer-open ?drawer))
      (move-drawer :close ?drawer ?arm))))

(def-cram-function search-drawer (?drawer ?type ?arm)
  (cpl:with-retry-counters ((openings 1))
    (cpl:with-failure-handling
        ((common-fail:manipulation-low-level-failure (e)
           (cpl:do-retry openings
             (close-all-drawers ?arm)
             (cpl:retry))
           (cpl:fail 'item-left-out :reason "the drawer does not open")))
      (unless (holds (list 'drawer-open ?drawer))
        (move-drawer :open ?drawer ?arm))
      (look-at (desig:a location (in (desig:an object (name ?drawer)))))
      (cpl:with-failure-handling
          ((common-fail:perception-low-level-failure (e) (return nil)))
        (detect ?type)))))

(def-cram-function find-in-drawers (?type ?arm)
  (let ((?found nil))
    (dolist (?drawer *drawers* ?found)
      (setf ?found (search-drawer ?drawer ?type ?arm))
      (when ?found (return ?found))
      (move-drawer :close ?drawer ?arm))))

;;; Bringing.

(def-cram-function fetch-from-counter (?type ?arm)
  (let ((?object (find-on-counter ?type)))
    (grasp ?object ?arm)
    (park ?arm)
    ?object))

(def-cram-function fetch-spoon (?arm)
  (unwind-protect
       (let ((?spoon (find-in-drawers :spoon ?arm)))
         (unless ?spoon
           (cpl:fail 'item-left-out :reason "in no drawer"))
         (grasp ?spoon ?arm)
         ?spoon)
    (close-all-drawers (if (eq ?arm :left) :right :left))
    (park-arms)))

(def-cram-function bring-two (?first-type ?second-type ?first-spot ?second-spot)
  (let* ((?left (fetch-from-counter ?first-type :left))
         (?right (fetch-from-counter ?second-type :right)))
    (drive-to *table-pose*)
    (cpl:par
      (put-down ?left :left ?first-spot)
      (put-down ?right :right ?second-spot))
    (park-arms)
    (drive-to *work-pose*)))

(def-cram-function lay-the-table ()
  (destructuring-bind (?bowl-spot ?cereal-spot ?milk-spot ?spoon-spot) *spots*
    (cpl:with-failure-handling
        ((item-left-out (e)
           (roslisp:ros-warn (demo) "no spoon today: ~a" e)
           (return)))
      (let ((?spoon (fetch-spoon :left)))
        (drive-to *table-pose*)
        (put-down ?spoon :left ?spoon-spot)
        (park-arms)
        (drive-to *work-pose*)))
    (bring-two :bowl :breakfast-cereal ?bowl-spot ?cereal-spot)
    (let ((?milk (fetch-from-counter :milk :right)))
      (drive-to *table-pose*)
      (put-down ?milk :right ?milk-spot))))

(lay-the-table)
