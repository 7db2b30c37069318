(in-package :kitchen-knowledge)

;; What stands where as a rule, and where it belongs when the table is laid.
(defparameter *object-knowledge*
  '((:milk             . (:counter 0 10))
    (:breakfast-cereal . (:counter 1 10))
    (:bowl             . (:counter 2 15))
    (:spoon            . (:drawer 3 5))))

(defun knowledge-of (type)
  (let ((entry (assoc type *object-knowledge*)))
    (unless (listp (cdr entry))
      (error "no knowledge about ~a" type))
    (or (cdr entry)
        (cpl:fail 'common-fail:object-nowhere-to-be-found))))

(defun get-object-likely-locations (type)
  (destructuring-bind (furniture cell effort) (knowledge-of type)
    (declare (ignore cell effort))
    (if (eq furniture :drawer)
        (mapcar #'drawer-location *drawers*)
        (mapcar (lambda (cell) (cell-location cell :counter-top)) *counter-cells*))))

(defun get-object-destinations (type)
  "The cell of the table that is the object's own first, then the others."
  (let* ((own (nth (second (knowledge-of type)) *table-cells*))
         (others (remove own *table-cells*)))
    (mapcar (lambda (cell) (cell-location cell :dinner-table))
            (cons own others))))

(defun get-object-grasps (type)
  (case type
    (:milk (list :front :left-side))
    ((:bowl :spoon) (list :top))
    (t (list :front))))

(defun get-object-type-effort (type)
  (third (knowledge-of type)))

(defun plain-key (property)
  (first property))

(def-fact-group object-knowledge (man-int:object-rotationally-symmetric man-int:object-likely-location)

  (<- (man-int:object-rotationally-symmetric :bowl))

  (<- (man-int:object-likely-location ?type ?location)
    (lisp-fun get-object-likely-locations ?type ?locations)
    (member ?location ?locations)))
