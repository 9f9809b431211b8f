// Where a test program finds the module that lib/images opens (lib/images/module.cpp).
extern "C" {
extern const char acdf_images_module_path[];
const char acdf_images_module_path[] = ACDF_IMAGES_MODULE;
}
