(defsystem seal-plans
  :author "the kitchen's people"
  :license "MIT"
  :depends-on (kitchen-knowledge mobile-plans cram-designators cram-executive cram-prolog)
  :serial t
  :components ((:file "package")
               (:file "seal-plans")
               (:file "seal-designators")))
