(in-package :kitchen-knowledge)

(defun map-pose (x y z &optional (rotation (cl-transforms:make-identity-rotation)))
  (cl-transforms-stamped:make-pose-stamped
   "map" 0.0 (cl-transforms:make-3d-vector x y z) rotation))

(defparameter *counter-cells*
  (list (map-pose 1.46 0.075 0.85) (map-pose 1.46 0.225 0.85) (map-pose 1.46 0.375 0.85)))

(defparameter *table-cells*
  (list (map-pose -0.82 0.475 0.86) (map-pose -0.82 0.625 0.86)
        (map-pose -0.82 0.775 0.86) (map-pose -0.82 0.925 0.86)))

(defparameter *drawers* '(:d-top :d-mid :d-low))

(defun counter-stand ()
  (let ((?pose (map-pose 0.72 0.06 0)))
    (desig:a location (pose ?pose))))

(defun table-stand ()
  (let ((?pose (map-pose -0.10 0.56 0 (cl-transforms:make-quaternion 0 0 1 0))))
    (desig:a location (pose ?pose))))

(defun cell-location (?cell ?furniture)
  "The cell at a pose on a piece of furniture."
  (desig:a location
           (pose ?cell)
           (on (desig:an object (type ?furniture)))))

(defun drawer-location (?drawer)
  (desig:a location (in (desig:an object (type drawer) (name ?drawer)))))

(defun location-container (location)
  "The container that `location' is in, or nil."
  (when (typep location 'desig:location-designator)
    (desig:desig-prop-value location :in)))

(defun pose-of (location)
  (let ((pose (desig:reference location)))
    (if (typep pose 'desig:designator)
        (error "~a is nowhere in particular" location)
        pose)))

(defun stand-for (location)
  "Where to stand for manipulating what is at `location'."
  (let ((furniture (desig:desig-prop-value location :on)))
    (cond ((location-container location)
           (counter-stand))
          ((and furniture (eq (desig:desig-prop-value furniture :type) :dinner-table))
           (table-stand))
          (t
           (counter-stand)))))

(def-fact-group location-knowledge (man-int:location-container man-int:location-stand)

  (<- (man-int:location-container ?location ?container)
    (desig:loc-desig? ?location)
    (spec:property ?location (:in ?container)))

  (<- (man-int:location-stand ?location ?stand)
    (lisp-fun stand-for ?location ?stand)
    (lisp-pred identity ?stand)))
