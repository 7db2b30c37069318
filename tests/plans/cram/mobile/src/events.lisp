(in-package :mobile-plans)

;; What the belief state hears. In the model the effects of the actions are the truth.

(defun announce (object arm &rest properties)
  (roslisp:ros-info (mobile events) "~a is in ~a now ~a" object arm properties)
  (cram-occasions-events:on-event
   (make-instance 'cpoe:object-attached-robot :object-name object :arm arm))
  nil)

(defun announce-change ()
  (cram-occasions-events:on-event (make-instance 'cpoe:robot-state-changed)))
