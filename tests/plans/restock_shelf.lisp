;; Restock the shelf with two arms: the left one brings what is fresh, the right one takes what is
;; stale away. What stands on a board is known only once the robot has looked at it.

(in-package :shelf-demo)

(defparameter *boards* '(:upper :middle :lower))
(defparameter *stock* '(:fresh1 :fresh2))

(def-cram-function face (?what)
  (ecase ?what
    (:shelf (exe:perform (desig:an action (type turning-to-shelf))))
    (:crate (exe:perform (desig:an action (type turning-to-crate))))))

(def-cram-function grasp (?product ?arm)
  (exe:perform (desig:an action (type picking-up) (arm ?arm) (object ?product))))

(def-cram-function put (?product ?arm ?spot)
  (exe:perform (desig:an action (type placing) (arm ?arm) (object ?product) (target ?spot))))

;; What is on the board, or nil.
(def-cram-function inspect-board (?board)
  (cpl:with-failure-handling
      ((common-fail:perception-low-level-failure (e)
         (roslisp:ros-info (shelf) "the ~a board is empty" ?board)
         (return nil)))
    (exe:perform (desig:a motion (type detecting) (location ?board)))))

(def-cram-function take-away (?product)
  (grasp ?product :right)
  (face :crate)
  (put ?product :right :crate)
  (face :shelf))

;; The next of the products that is still in the crate; grasping one that is not there fails.
(defun fetch-fresh (?products)
  (face :crate)
  (dolist (?product ?products)
    (cpl:with-failure-handling
        ((common-fail:manipulation-low-level-failure (e)
           (roslisp:ros-info (shelf) "~a is on the shelf already" ?product)
           (return)))
      (grasp ?product :left)
      (face :shelf)
      (return-from fetch-fresh ?product)))
  (cpl:fail 'common-fail:object-nowhere-to-be-found))

(defun put-somewhere (?product)
  (dolist (?board *boards*)
    (let ((?there (inspect-board ?board)))
      (when (and ?there (eq ?there :stale1))
        (take-away ?there)
        (setf ?there nil))
      (unless ?there
        (put ?product :left ?board)
        (return-from put-somewhere ?board))))
  (cpl:fail 'common-fail:object-undeliverable))

(def-cram-function restock ()
  (dotimes (?turn 2)
    (cpl:with-failure-handling
        ((common-fail:object-nowhere-to-be-found (e)
           (roslisp:ros-info (shelf) "nothing is left in the crate")
           (return)))
      (put-somewhere (fetch-fresh *stock*)))))

(restock)
