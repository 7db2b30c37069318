(in-package :table-plans)

(defparameter *table-setting* '(:milk :bowl)
  "What is brought, in this order.")

(defun stands-near (location)
  "Where to stand for a location, and a second way to stand there."
  (let* ((stand (kit:stand-for location))
         (pose (kit:pose-of stand))
         (origin (cl-transforms:origin pose)))
    (list stand
          (desig:make-designator
           :location
           `((:pose ,(cl-transforms-stamped:make-pose-stamped
                      (cl-transforms-stamped:frame-id pose) 0.0
                      (cl-transforms:make-3d-vector
                       (+ (cl-transforms:x origin) 0.02)
                       (cl-transforms:y origin)
                       (cl-transforms:z origin))
                      (cl-transforms:orientation pose))))))))

(defun look-everywhere (?object locations)
  (dolist (?location locations)
    (exe:perform (desig:an action (type turning-towards) (target ?location)))
    (let ((found nil))
      (cpl:with-failure-handling
          ((common-fail:perception-low-level-failure (e)
             (roslisp:ros-info (table look) "~a" e)
             (return)))
        (setf found (exe:perform (desig:an action (type perceiving) (object ?object)))))
      (when found
        (return-from look-everywhere ?location))))
  (cpl:fail 'common-fail:object-nowhere-to-be-found))

(defun bring-one (&key
                    ((:object ?object))
                    ((:type type))
                    ((:locations locations))
                    ((:targets targets))
                  &allow-other-keys)
  "Fetches one thing and puts it on the table; from another stance and to another cell if need be."
  (when (null type)
    (error "bring what?"))
  (let* ((stances (stands-near (first locations)))
         (?stance (pop-first stances))
         (?where nil))
    (cpl:with-retry-counters ((stance-retries 1))
      (cpl:with-failure-handling
          (((or common-fail:navigation-high-level-failure
                common-fail:manipulation-low-level-failure)
               (e)
             (roslisp:ros-warn (table fetch) "from ~a: ~a" ?stance e)
             (cpl:do-retry stance-retries
               (setf ?stance (second stances))
               (cpl:retry))
             (cpl:fail 'common-fail:object-unfetchable)))
        (exe:perform (desig:an action (type navigating) (location ?stance)))
        (setf ?where (look-everywhere ?object locations))
        (mob:pick-up-with ?object :left)))
    (exe:perform (desig:an action (type parking-arms)))
    (roslisp:ros-info (table fetch) "it was at ~a" ?where)
    (put-down ?object targets)))

(defun pop-first (list)
  (car list))

(defun put-down (?object targets)
  (let ((?stand (kit:stand-for (first targets))))
    (exe:perform (desig:an action (type navigating) (location ?stand)))
    (cpl:try-each-in-order (?target targets)
      (mob:place-at ?object :left ?target)
      (exe:perform (desig:an action (type parking-arms) (arms (left))))
      (return ?target))))

(defun set-table (&key ((:things things)) &allow-other-keys)
  "Brings what can be brought; what cannot is told and left out."
  (let ((brought nil))
    (dolist (?type things)
      (cpl:with-failure-handling
          ((common-fail:high-level-failure (e)
             (roslisp:ros-warn (table set) "no ~a: ~a" ?type e)
             (return))
           (cpl:composite-failure (e)
             (roslisp:ros-warn (table set) "no room for ~a: ~a" ?type e)
             (return)))
        (let ((?object (desig:an object (type ?type))))
          (exe:perform (desig:an action (type bringing) (object ?object)))
          (push ?type brought))))
    (unless (every #'symbolp brought)
      (error "what was brought? ~a" brought))
    (reverse brought)))
