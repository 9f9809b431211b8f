// Where a test program finds the modules that lib/images opens (lib/images/module.cpp).
extern "C" {
extern const char acdf_images_folder[];
const char acdf_images_folder[] = ACDF_IMAGES_FOLDER;
}
