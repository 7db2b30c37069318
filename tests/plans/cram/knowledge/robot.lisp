(in-package :kitchen-knowledge)

(defparameter *robot-name* :pr2)

(def-fact-group robot-knowledge (rob-int:robot rob-int:arm rob-int:environment-name)

  (<- (rob-int:robot :pr2))

  (<- (rob-int:environment-name :kitchen))

  (<- (rob-int:arm :pr2 :left))
  (<- (rob-int:arm :pr2 :right))

  (<- (rob-int:arm-name :left "l_arm"))
  (<- (rob-int:arm-name :right "r_arm"))

  ;; (?arm . ?torso): at which height an arm reaches what lies high
  (<- (reach-height (:left . :torso-high)))
  (<- (reach-height (:right . :torso-high))))

(defun arms-for (grasp)
  "The arms that `grasp' is possible with, the better one first."
  (case grasp
    ((:top :front) (list :left :right))
    (:left-side (list :left))
    (:right-side (list :right))
    (t (list :left :right))))
