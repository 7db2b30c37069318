(defsystem table-plans
  :author "the kitchen's people"
  :license "MIT"
  :depends-on (kitchen-knowledge mobile-plans cram-designators cram-executive cram-prolog)
  :serial t
  :components ((:file "package")
               (:file "table-plans")
               (:file "table-designators")))
